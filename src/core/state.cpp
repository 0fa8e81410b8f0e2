#include "afm/state.h"

#include "afm/surface.h"

namespace afm {

ModelTime multiply(std::uint64_t n, double period) {
  const double count = static_cast<double>(n);
  const double product = count * period;
  const double rest = std::fma(count, period, -product);
  const double whole = std::floor(product);
  return ModelTime{static_cast<std::int64_t>(whole), 0.0} + ((product - whole) + rest);
}

TipState to_tip_state(double H, const FreeState& s) {
  const SurfaceJet<double> surface = surface_jet(H, s.phase);
  return {wrap_phase(s.phase), s.X, s.u, s.y - surface.h, s.w - surface.h1 * s.u};
}

FreeState to_free_state(double H, const TipState& s) {
  const SurfaceJet<double> surface = surface_jet(H, s.phase);
  return {s.phase, s.X, surface.h + s.g, s.u, s.g1 + surface.h1 * s.u};
}

}  // namespace afm
