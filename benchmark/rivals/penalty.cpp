// A stiff spring and a dashpot instead of the impact, integrated by Runge and Kutta's fourth order. The dashpot is that
// which gives the restitution of the speed of approach; the spring is as stiff as the step resolves: sixteen steps a
// contact. Steps end where contact begins and ends (the force jumps there), found by TOMS 748 over the length of the
// step.
#include "impact_law.h"

namespace afm::rivals {
namespace {

constexpr double kPi = 0.5 * kTwoPi;
constexpr double kStepsAContact = 16.0;

class Penalty {
 public:
  explicit Penalty(double h) : h_(h), omega_(kPi / (kStepsAContact * h)) {}

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
    const Oscillator o(model, eta, start);
    Point p = o.begin;
    double damping = 0.0, onset = 0.0, before = 0.0;
    bool touching = false;
    for (double t = 0.0; t < horizon;) {
      Point next = step(o, p, t, h_, damping, touching);
      if (!(std::fabs(next[0]) + std::fabs(next[2]) < 1e6)) return {Hit::diverged, t, start, 0.0};
      const double g = o.gap(next, t + h_);
      const bool falls = !touching && g < 0.0 && normal_velocity(o, next, t + h_) < 0.0, leaves = touching && g >= 0.0;
      if (!falls && !leaves) {
        p = next;
        t += h_;
        continue;
      }
      const double h = length_to_surface(o, p, t, g, damping, touching);
      p = step(o, p, t, h, damping, touching);
      t += h;
      const double speed = normal_velocity(o, p, t);
      if (leaves) return {Hit::impact, t, o.tip_state(p, t), 0.5 * (before * before - speed * speed), t - onset};
      onset = t;
      before = -speed;
      damping = dashpot(restitution(model, before));
      touching = true;
    }
    return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
  }

 private:
  // Of a damped half swing that leaves e of its speed.
  double dashpot(double e) const {
    const double decrement = -std::log(std::fmax(e, 1e-12));
    return 2.0 * omega_ * decrement / std::sqrt(kPi * kPi + decrement * decrement);
  }

  static double normal_velocity(const Oscillator& o, const Point& p, double s) {
    const double h1 = o.slope(o.phase(p, s));
    return (p[3] - h1 * (o.eta + p[1])) / std::sqrt(1.0 + h1 * h1);
  }

  Point rate(const Oscillator& o, const Point& p, double s, double damping) const {
    Point r = o.rate(p);
    const double x = o.phase(p, s), g = p[2] + o.model.y0 - o.height(x);
    const double h1 = o.slope(x), n = std::sqrt(1.0 + h1 * h1);
    const double force = -omega_ * omega_ * g / n - damping * (p[3] - h1 * (o.eta + p[1])) / n;
    r[1] -= h1 / n * force;
    r[3] += force / n;
    return r;
  }

  Point step(const Oscillator& o, const Point& p, double s, double h, double damping, bool touching) const {
    const auto f = [&](const Point& q, double t) { return touching ? rate(o, q, t, damping) : o.rate(q); };
    const auto along = [&p](const Point& v, double dt) -> Point {
      return {p[0] + dt * v[0], p[1] + dt * v[1], p[2] + dt * v[2], p[3] + dt * v[3]};
    };
    const double half = 0.5 * h;
    const Point a = f(p, s), b = f(along(a, half), s + half), c = f(along(b, half), s + half);
    const Point d = f(along(c, h), s + h);
    Point next = p;
    for (std::size_t i = 0; i < next.size(); ++i) next[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
    return next;
  }

  // Of the step that ends on the surface; the whole step where it begins on the other side already, by rounding.
  double length_to_surface(const Oscillator& o, const Point& p, double t, double at_end, double damping,
                           bool touching) const {
    const auto gap = [&](double h) { return o.gap(step(o, p, t, h, damping, touching), t + h); };
    const double at_begin = gap(0.0);
    if (!(at_begin * at_end < 0.0)) return h_;
    boost::uintmax_t most = 50;
    const auto root = boost::math::tools::toms748_solve(gap, 0.0, h_, at_begin, at_end,
                                                        boost::math::tools::eps_tolerance<double>(40), most);
    return touching ? root.second : root.first;
  }

  double h_, omega_;
};

}  // namespace

MethodSpec penalty_spec() {
  return {"penalty", {1e-3, 1e-4, 3e-5, 1e-5}, 3e-5, [](double h) { return make_method<Penalty>(h); }};
}

}  // namespace afm::rivals
