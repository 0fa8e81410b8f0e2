// heyoka: Taylor's method in compiled code, with event detection on the series of each step. As its manual recommends:
// the gap is a terminal event of falling direction, the model's numbers are runtime parameters, so it compiles once.
#include <algorithm>
#include <heyoka/heyoka.hpp>
#include <iterator>
#include <limits>
#include <tuple>
#include <vector>

#include "impact_law.h"

namespace afm::rivals {
namespace {

using Integrator = heyoka::taylor_adaptive<double>;
using heyoka::par;

constexpr double kMachinePrecision = std::numeric_limits<double>::epsilon();

Integrator make_integrator(double tolerance) {
  const auto [X, U, Y, W] = heyoka::make_vars("X", "U", "Y", "W");
  const auto wh2 = par[0], wv2 = par[1], c = par[2], eta = par[3], H = par[4], y0 = par[5];
  const auto gap = Y + y0 - H * heyoka::cos(kTwoPi * (c + eta * heyoka::time + X));
  const heyoka::t_event<double> impact(gap, heyoka::kw::direction = heyoka::event_direction::negative);
  return Integrator({prime(X) = U, prime(U) = -wh2 * X, prime(Y) = W, prime(W) = -wv2 * Y}, {0.0, 0.0, 0.0, 0.0},
                    heyoka::kw::tol = tolerance, heyoka::kw::high_accuracy = tolerance <= kMachinePrecision,
                    heyoka::kw::t_events = {impact});
}

class Heyoka {
 public:
  explicit Heyoka(double tolerance) : integrator_(make_integrator(tolerance)) {
    heyoka::set_logger_level_err();  // its warnings would stand in our tables
  }

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
    const Oscillator o(model, eta, start);
    begin(o);
    const double first_look = o.first_look(grid(o));
    for (;;) {
      const heyoka::taylor_outcome outcome = std::get<0>(integrator_.step(horizon - integrator_.get_time()));
      const double s = integrator_.get_time();
      const Point p = point();
      if (outcome == heyoka::taylor_outcome::err_nf_state) return {Hit::diverged, s, o.tip_state(o.begin, 0.0), 0.0};
      if (outcome == heyoka::taylor_outcome::time_limit) return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
      const bool event = outcome > heyoka::taylor_outcome::success;
      if (event && s >= first_look && o.gap_rate(p, s) < 0.0) return reflect(o, p, s);
    }
  }

 private:
  void begin(const Oscillator& o) {
    const double parameters[] = {o.wh2, o.wv2, o.c, o.eta, o.model.H, o.model.y0};
    std::copy(std::begin(parameters), std::end(parameters), integrator_.get_pars_data());
    std::copy(o.begin.begin(), o.begin.end(), integrator_.get_state_data());
    integrator_.set_time(0.0);
    integrator_.reset_cooldowns();
  }

  Point point() const {
    const std::vector<double>& q = integrator_.get_state();
    return {q[0], q[1], q[2], q[3]};
  }

  Integrator integrator_;
};

}  // namespace

MethodSpec heyoka_spec() {
  return {"heyoka", {1e-9, kMachinePrecision}, kMachinePrecision, [](double tolerance) {
            return make_method<Heyoka>(tolerance);
          }};
}

}  // namespace afm::rivals
