// What games and many simulators do: velocity first, then position; a step that ends below the surface puts the tip
// back on it and reflects the velocity.
#include "impact_law.h"

namespace afm {
namespace rivals {
namespace {

class SemiImplicitEuler : public Method {
 public:
  explicit SemiImplicitEuler(double h) : h_(h) {}

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) override {
    const Oscillator o(model, eta, start);
    Point p = o.begin;
    for (double t = 0.0; t < horizon; t += h_) {
      p[1] -= h_ * o.wh2 * p[0];
      p[3] -= h_ * o.wv2 * p[2];
      p[0] += h_ * p[1];
      p[2] += h_ * p[3];
      const double now = t + h_;
      if (!(std::fabs(p[0]) + std::fabs(p[2]) < 1e6)) return {Hit::diverged, now, start, 0.0};
      if (o.gap(p, now) < 0.0) {
        p[2] = o.height(o.phase(p, now)) - o.model.y0;
        if (o.gap_rate(p, now) < 0.0) return reflect(o, p, now);
      }
    }
    return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
  }

 private:
  double h_;
};

}  // namespace

MethodSpec semi_implicit_euler_spec() {
  return {"semi_implicit_euler", "step", {1e-2, 1e-3, 1e-4, 1e-5}, 1e-4, [](double h) {
            return std::make_unique<SemiImplicitEuler>(h);
          }};
}

}  // namespace rivals
}  // namespace afm
