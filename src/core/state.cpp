#include "afm/state.h"

#include <cmath>
#include <limits>

#include "afm/model.h"
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
  constexpr double kRoundings = 8.0;
  const SurfaceJet<double> surface = surface_jet(H, s.phase);
  const double gap = s.y - surface.h;
  const double rounding = kRoundings * std::numeric_limits<double>::epsilon() * H * (1.0 + kTwoPi * std::abs(s.phase));
  return {wrap_phase(s.phase), s.X, s.u, -rounding <= gap && gap < 0.0 ? 0.0 : gap, s.w - surface.h1 * s.u};
}

FreeState to_free_state(double H, const TipState& s) {
  const SurfaceJet<double> surface = surface_jet(H, s.phase);
  return {s.phase, s.X, surface.h + s.g, s.u, s.g1 + surface.h1 * s.u};
}

}  // namespace afm
