// Boost.Odeint with adaptive steps and dense output: each step's interpolant is sampled, and solved where it crosses
// zero; with minima also where the gap turns from falling to rising.
#include <boost/numeric/odeint.hpp>

#include "impact_law.h"

namespace afm::rivals {
namespace {

namespace odeint = boost::numeric::odeint;

using Dopri5 = odeint::result_of::make_dense_output<odeint::runge_kutta_dopri5<Point>>::type;
using BulirschStoer = odeint::bulirsch_stoer_dense_out<Point>;

template <class Stepper>
Stepper make_stepper(double tolerance);
template <>
Dopri5 make_stepper<Dopri5>(double tolerance) {
  return odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<Point>());
}
template <>
BulirschStoer make_stepper<BulirschStoer>(double tolerance) {
  return BulirschStoer(tolerance, tolerance);
}

template <class Stepper>
class Odeint {
 public:
  Odeint(double tolerance, double first_step, bool minima)
      : stepper_(make_stepper<Stepper>(tolerance)), first_step_(first_step), minima_(minima) {}

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
    const Oscillator o(model, eta, start);
    const auto rate = [&o](const Point& p, Point& dpdt, double) { dpdt = o.rate(p); };
    Point p;
    const auto at = [&](double s) {
      stepper_.calc_state(s, p);
      return GapRate{o.gap(p, s), minima_ ? o.gap_rate(p, s) : 0.0};
    };
    CrossingWatch watch(o, grid(o));
    stepper_.initialize(o.begin, 0.0, first_step_);
    for (;;) {
      const std::pair<double, double> span = stepper_.do_step(rate);
      const double s = watch.look(at, span.first, std::fmin(span.second, horizon));
      if (s >= 0.0) {
        stepper_.calc_state(s, p);
        return reflect(o, p, s);
      }
      if (span.second < horizon) continue;
      stepper_.calc_state(horizon, p);
      return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
    }
  }

 private:
  Stepper stepper_;
  double first_step_;
  bool minima_;
};

MethodSpec dopri5_spec(const char* name, bool minima) {
  return {name, {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}, 1e-10, [minima](double tolerance) {
            // near the step at which it arrives by itself
            return make_method<Odeint<Dopri5>>(tolerance, 0.1 * std::pow(tolerance, 0.2), minima);
          }};
}

}  // namespace

MethodSpec dopri5_spec() { return dopri5_spec("odeint_dopri5", false); }
MethodSpec dopri5_minima_spec() { return dopri5_spec("odeint_dopri5_minima", true); }

MethodSpec bulirsch_stoer_spec() {
  return {"odeint_bulirsch_stoer", {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}, 1e-10, [](double tolerance) {
            return make_method<Odeint<BulirschStoer>>(tolerance, 0.02, false);
          }};
}

}  // namespace afm::rivals
