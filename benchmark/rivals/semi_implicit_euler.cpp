// What games and many simulators do: velocity first, then position; a step that ends below the surface puts the tip
// back on it and reflects the velocity.
#include "impact_law.h"

namespace afm::rivals {
namespace {

Hit next_impact(double h, const Model& model, double eta, const TipState& start, double horizon) {
  const Oscillator o(model, eta, start);
  Point p = o.begin;
  for (double t = 0.0; t < horizon; t += h) {
    p[1] -= h * o.wh2 * p[0];
    p[3] -= h * o.wv2 * p[2];
    p[0] += h * p[1];
    p[2] += h * p[3];
    const double now = t + h;
    if (!(std::fabs(p[0]) + std::fabs(p[2]) < 1e6)) return {Hit::diverged, now, start, 0.0};
    if (o.gap(p, now) < 0.0) {
      p[2] = o.height(o.phase(p, now)) - o.model.y0;
      if (o.gap_rate(p, now) < 0.0) return reflect(o, p, now);
    }
  }
  return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
}

}  // namespace

MethodSpec semi_implicit_euler_spec() {
  return {"semi_implicit_euler", {1e-2, 1e-3, 1e-4, 1e-5}, 1e-4, [](double h) {
            return [h](const auto&... flight) { return next_impact(h, flight...); };
          }};
}

}  // namespace afm::rivals
