#include "deflection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/detail/multiversion.h"

namespace afm {
namespace {

// `displacement` must outlive the path.
template <class Slide>
SlidePath<double> path_of(const Slide& slide, const Series<double>& displacement) {
  const Mechanics<double>& m = slide.mechanics();
  return {slide.start().phase, slide.start().X, slide.eta(), m.H, m.y0, displacement};
}

AFM_MULTIVERSION Deflection at(const Flight<double>& flight, double s) { return flight_deflection(flight, s); }
AFM_MULTIVERSION Deflection at(const SlidePath<double>& reference, double s) { return slide_deflection(reference, s); }

// True: sums of whole tau are exact in the lanes up to the last sample.
bool exact(const lanes::SampleClock& clock, double last) {
  return std::max({last, last * clock.period, std::abs(clock.origin_tau)}) < lanes::kMaxExact;
}

}  // namespace

lanes::SampleRow row_of(const Flight<double>& flight) {
  const GapJet<double>& o = flight.start();
  const Mechanics<double>& m = flight.mechanics();
  lanes::SampleRow row;
  row.on_slide = false;
  row.phase = o.state.phase, row.X = o.state.X, row.U = o.state.U, row.Y = o.state.Y, row.W = o.state.W;
  row.g = o.g, row.g1 = o.g1, row.h = o.h, row.h1 = o.h1, row.fastest = flight.bounds().fastest;
  row.ratio = m.ratio, row.omega_h = m.omega_h, row.inverse_omega_h = m.inverse_omega_h, row.H = m.H, row.y0 = m.y0;
  row.eta = flight.eta();
  return row;
}

lanes::SampleRow row_of(const SlidePath<double>& reference) {
  lanes::SampleRow row;
  row.on_slide = true;
  row.phase = reference.phase, row.X = reference.X, row.H = reference.H, row.y0 = reference.y0, row.eta = reference.eta;
  row.displacement = reference.displacement.data();
  return row;
}

Deflection Tip::deflection(const ModelTime& t) const {
  if (in_contact()) return at(path_of(contact_, contact_.displacement()), t - start_);
  if (in_chatter()) return at(path_of(slide_, slide_.displacement()), t - start_);
  return at(flight_, t - start_);
}

double Tip::deflections(const SampleGrid& grid, std::uint64_t first, std::size_t n, double* vertical,
                        double* lateral) const {
  constexpr std::size_t kMinInLanes = 3;  // a pack costs about as much as three numbers
  const lanes::SampleClock clock{grid.period, static_cast<double>(grid.origin.tau - start_.tau), grid.origin.phase,
                                 start_.phase};
  const double count = static_cast<double>(first - grid.first);
  const lanes::Sampler in_lanes = n < kMinInLanes ? nullptr : lanes::sampler_in(8);
  if (in_lanes != nullptr && exact(clock, count + static_cast<double>(n))) {
    const Series<double> displacement = in_contact() ? contact_.displacement() : slide_.displacement();
    lanes::SampleRow row = in_contact()   ? row_of(path_of(contact_, displacement))
                           : in_chatter() ? row_of(path_of(slide_, displacement))
                                          : row_of(flight_);
    row.clock = clock;
    row.first = count, row.n = n, row.vertical = vertical, row.lateral = lateral;
    return in_lanes(row);
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const Deflection d = deflection(grid.time(first + i));
    vertical[i] = d.vertical;
    lateral[i] = d.lateral;
    lowest = std::min(lowest, d.gap);
  }
  return lowest;
}

}  // namespace afm
