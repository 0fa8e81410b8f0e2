// Moreau and Jean's time stepping: theta = 1/2 (the motion between impacts conserves energy), Newton's impact law as an
// inequality on velocities, active where the gap half a step on would be closed. It looks for no impact times.
#include "impact_law.h"

namespace afm::rivals {
namespace {

// One oscillator by the implicit midpoint rule: the velocity after a step of h.
double free_velocity(double q, double v, double w2, double h) {
  const double k = 0.25 * h * h * w2;
  return (v * (1.0 - k) - h * w2 * q) / (1.0 + k);
}

// Whether there was an impulse, and the energy it took: its work on the mean of the velocities before and after.
bool step(const Oscillator& o, Point& p, double t, double h, double& lost) {
  const double U = free_velocity(p[0], p[1], o.wh2, h), W = free_velocity(p[2], p[3], o.wv2, h);
  const Point half{p[0] + 0.5 * h * p[1], p[1], p[2] + 0.5 * h * p[3], p[3]};
  const double ahead = t + 0.5 * h;
  double du = 0.0, dw = 0.0;
  bool struck = false;
  if (o.gap(half, ahead) <= 0.0) {
    const double h1 = o.slope(o.phase(half, ahead)), n = std::sqrt(1.0 + h1 * h1);
    const double before = (p[3] - h1 * (o.eta + p[1])) / n, free = (W - h1 * (o.eta + U)) / n;
    const double e = before < 0.0 ? restitution(o.model, -before) : 0.0;
    const double impulse = -free - e * before;  // the normal velocity becomes -e times what it was
    if (impulse > 0.0) {
      // effective masses of the two implicit oscillators
      const double mh = 1.0 + 0.25 * h * h * o.wh2, mv = 1.0 + 0.25 * h * h * o.wv2;
      const double P = impulse / ((h1 * h1 / mh + 1.0 / mv) / (n * n));
      du = -h1 / n * P / mh;
      dw = P / n / mv;
      lost = -0.5 * P * (1.0 - e) * before;
      struck = true;
    }
  }
  p = {p[0] + 0.5 * h * (p[1] + U + du), U + du, p[2] + 0.5 * h * (p[3] + W + dw), W + dw};
  return struck;
}

Hit next_impact(double h, const Model& model, double eta, const TipState& start, double horizon) {
  const Oscillator o(model, eta, start);
  Point p = o.begin;
  for (double t = 0.0; t < horizon; t += h) {
    double lost = 0.0;
    const bool struck = step(o, p, t, h, lost);
    if (!(std::fabs(p[0]) + std::fabs(p[2]) < 1e6)) return {Hit::diverged, t + h, start, 0.0};
    if (struck) return {Hit::impact, t + h, o.tip_state(p, t + h), lost};
  }
  return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
}

}  // namespace

MethodSpec moreau_jean_spec() {
  return {"moreau_jean", {1e-2, 1e-3, 1e-4, 1e-5}, 1e-3, [](double h) {
            return [h](const auto&... flight) { return next_impact(h, flight...); };
          }};
}

}  // namespace afm::rivals
