// The exact flow in closed form, sampled at a fixed spacing; TOMS 748 where the gap has changed sign. With minima: TOMS
// 748 on the gap rate too, where that has changed from falling to rising, so that a touch between two samples is seen.

#include "impact_law.h"

namespace afm::rivals {
namespace {

Point flow(const Oscillator& o, double s) {
  const Point& b = o.begin;
  const double wh = kTwoPi * o.model.frequency_ratio;
  const double ch = std::cos(wh * s), sh = std::sin(wh * s), cv = std::cos(kTwoPi * s), sv = std::sin(kTwoPi * s);
  return {b[0] * ch + b[1] / wh * sh, b[1] * ch - b[0] * wh * sh, b[2] * cv + b[3] / kTwoPi * sv,
          b[3] * cv - b[2] * kTwoPi * sv};
}

Hit next_impact(double spacing, bool minima, const Model& model, double eta, const TipState& start, double horizon) {
  const Oscillator o(model, eta, start);
  const auto at = [&](double s) {
    const Point& b = o.begin;
    if (minima) {
      const Point p = flow(o, s);
      return GapRate{o.gap(p, s), o.gap_rate(p, s)};
    }
    const double wh = kTwoPi * o.model.frequency_ratio;
    const double X = b[0] * std::cos(wh * s) + b[1] / wh * std::sin(wh * s);
    const double Y = b[2] * std::cos(kTwoPi * s) + b[3] / kTwoPi * std::sin(kTwoPi * s);
    return GapRate{Y + o.model.y0 - o.height(o.c + o.eta * s + X)};
  };
  CrossingWatch watch(o, spacing);
  const double s = watch.look(at, 0.0, horizon);
  if (s < 0.0) return {Hit::none, horizon, o.tip_state(flow(o, horizon), horizon), 0.0};
  return reflect(o, flow(o, s), s);
}

MethodSpec spec(const char* name, bool minima, std::vector<double> settings) {
  return {name, std::move(settings), 0.02, [minima](double spacing) {
            return [=](const auto&... flight) { return next_impact(spacing, minima, flight...); };
          }};
}

}  // namespace

MethodSpec sampled_spec() { return spec("sampled_toms748", false, {0.05, 0.02, 0.005, 0.001}); }
MethodSpec sampled_minima_spec() { return spec("sampled_minima", true, {0.1, 0.05, 0.02, 0.01, 0.005}); }

}  // namespace afm::rivals
