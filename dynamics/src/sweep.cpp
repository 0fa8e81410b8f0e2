#include "afm/dynamics/sweep.h"

#include <algorithm>

#include "afm/dynamics/attractor.h"
#include "afm/tip.h"

namespace afm {
namespace {

// [tau] A choice: it gives exponents to a few per cent and costs more than the friction.
constexpr double kLyapunovDuration = 2000.0;

AttractorSettings search_settings(const SweepSettings& settings) {
  AttractorSettings search;
  search.transient = settings.transient;
  search.duration = std::min(settings.duration, kLyapunovDuration);
  return search;
}

}  // namespace

// With a bath there is no attractor, only averages.
SweepResult sweep_attractor(const SweepPoint& point, const SweepSettings& settings, const TipState& start) {
  if (settings.bath.is_on()) return sweep_point(point, settings, start);
  const Model model = model_of(point);
  Tip tip(model, point.eta, start);
  const Attractor attractor = find_attractor(model, tip, search_settings(settings));
  SweepResult result;
  result.attractor = attractor.name();
  result.largest_lyapunov = attractor.lyapunov.exponents[0];
  result.friction = average_over_periods(tip, attractor.cells, settings.duration);
  result.end = tip.tip_state();
  return result;
}

}  // namespace afm
