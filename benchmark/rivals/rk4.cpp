// Runge and Kutta's fourth order at a fixed step; where the gap has changed sign the step is made again, shorter, until
// it ends on the surface (TOMS 748 over its length).
#include "impact_law.h"

namespace afm::rivals {
namespace {

Point along(const Point& p, const Point& rate, double h) {
  return {p[0] + h * rate[0], p[1] + h * rate[1], p[2] + h * rate[2], p[3] + h * rate[3]};
}

Point step(const Oscillator& o, const Point& p, double h) {
  const Point a = o.rate(p), b = o.rate(along(p, a, 0.5 * h)), c = o.rate(along(p, b, 0.5 * h));
  const Point d = o.rate(along(p, c, h));
  Point next = p;
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  return next;
}

Hit next_impact(double step_length, const Model& model, double eta, const TipState& start, double horizon) {
  const Oscillator o(model, eta, start);
  CrossingWatch watch(o, step_length);
  Point p = o.begin;
  for (double t = 0.0; t < horizon; t += step_length) {
    const double h = std::fmin(step_length, horizon - t);
    const auto at = [&](double s) { return GapRate{o.gap(step(o, p, s - t), s)}; };
    const double s = watch.look(at, t, t + h);
    if (s >= 0.0) return reflect(o, step(o, p, s - t), s);
    p = step(o, p, h);
  }
  return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
}

}  // namespace

MethodSpec rk4_spec() {
  return {"rk4", {1e-2, 3e-3, 1e-3, 1e-4}, 1e-3, [](double h) {
            return [h](const auto&... flight) { return next_impact(h, flight...); };
          }};
}

}  // namespace afm::rivals
