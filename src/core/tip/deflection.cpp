// Samples of the deflection.
#include <algorithm>
#include <limits>

#include "afm/contact.h"
#include "afm/tip.h"

namespace afm {
namespace {

// Height and extension are those of Flight::gap, without its derivatives.
Deflection flight_deflection(const Flight<double>& flight, double s) {
  if (flight.is_small(s)) {
    const GapJet<double> jet = flight.gap_by_small_turns(s);
    return {jet.state.Y, jet.state.X, jet.g};
  }
  const FlightState<double> q = flight.at(s);
  const Mechanics<double>& m = flight.mechanics();
  return {q.Y, q.X, q.Y + m.y0 - surface_jet(m.H, q.phase).h};
}

// `slide`: a step in contact or a reference slide. `displacement`: its series, which a step in contact makes when asked.
template <class Slide>
Deflection slide_deflection(const Slide& slide, const Series<double>& displacement, double s) {
  const Mechanics<double>& m = slide.mechanics();
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
  if (in_contact()) {
    const Series<double> displacement = contact_.displacement();
    take([&](double s) { return slide_deflection(contact_, displacement, s); });
  } else if (in_chatter()) {
    take([&](double s) { return slide_deflection(slide_, slide_.displacement(), s); });
  } else {
    take([&](double s) { return flight_deflection(flight_, s); });
  }
  return lowest;
}

Deflection Tip::deflection(const ModelTime& t) const {
  Deflection d;
  d.gap = deflections({1.0, 0, t}, 0, 1, &d.vertical, &d.lateral);
  return d;
}

}  // namespace afm
