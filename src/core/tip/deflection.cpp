// Samples of the deflection.
#include <algorithm>
#include <limits>

#include "afm/tip.h"

namespace afm {

using namespace detail;

namespace {

// Height and extension are those of Flight::gap, without its derivatives.
Deflection flight_deflection(const Flight<double>& flight, double s) {
  if (is_small(bounds_of(flight), s)) {
    const GapJet<double> jet = advance_jet(flight.springs(), flight.eta(), flight.start(), s);
    return {jet.state.Y, jet.state.X, jet.g};
  }
  const FlightState<double> q = flight.at(s);
  const SpringConstants<double>& m = flight.springs();
  return {q.Y, q.X, q.Y + m.y0 - surface_jet(m.H, q.phase).h};
}

// `slide`: a step in contact or a reference slide. `displacement`: its series; a step in contact makes it when asked.
template <class Slide>
Deflection slide_deflection(const Slide& slide, const Series<double>& displacement, double s) {
  const SpringConstants<double>& m = slide.springs();
  const double d = horner(displacement, s);
  return {surface_jet(m.H, slide.start().phase + d).h - m.y0, slide.start().X + (d - slide.eta() * s), 0.0};
}

}  // namespace

double Tip::deflections(const SampleGrid& grid, std::uint64_t first, std::size_t n, double* vertical,
                        double* lateral) const {
  double lowest = std::numeric_limits<double>::infinity();
  const auto take = [&](const auto& deflection_at) {
    for (std::size_t i = 0; i < n; ++i) {
      const Deflection d = deflection_at(grid.time(first + i) - start_);
      vertical[i] = d.vertical;
      lateral[i] = d.lateral;
      lowest = std::min(lowest, d.gap);
    }
  };
  if (const Flying* flying = std::get_if<Flying>(&phase_)) {
    take([&](double s) { return flight_deflection(flying->flight, s); });
  } else if (const Sliding* sliding = std::get_if<Sliding>(&phase_)) {
    const Series<double> displacement = sliding->step.displacement();
    take([&](double s) { return slide_deflection(sliding->step, displacement, s); });
  } else if (const Chattering* chattering = std::get_if<Chattering>(&phase_)) {
    const SlideSegment<double>& reference = chattering->reference;
    take([&](double s) { return slide_deflection(reference, reference.displacement(), s); });
  } else {
    const FreeState touching = state();
    take([&](double) -> Deflection { return {touching.y - model_.y0, touching.X, 0.0}; });
  }
  return lowest;
}

Deflection Tip::deflection(const ModelTime& t) const {
  Deflection d;
  d.gap = deflections({1.0, 0, t}, 0, 1, &d.vertical, &d.lateral);
  return d;
}

}  // namespace afm
