// Samples of one segment of motion, as many at once as a register has lanes. Include a register first.
#pragma once

#include <limits>

#include "core/tip/deflection.h"
#include "pack.h"
#include "sample_row.h"

namespace afm {
namespace {

using lanes::SampleRow;
using PackDeflection = DeflectionOf<Pack>;

AFM_LANE_INLINE PackDeflection select(M m, const PackDeflection& a, const PackDeflection& b) {
  return {select(m, a.vertical, b.vertical), select(m, a.lateral, b.lateral), select(m, a.gap, b.gap)};
}

AFM_LANE_INLINE Flight<Pack> flight_of(const SampleRow& row) {
  Mechanics<Pack> m;
  m.ratio = Pack(row.ratio), m.omega_h = Pack(row.omega_h), m.inverse_omega_h = Pack(row.inverse_omega_h);
  m.omega_v = Pack(kTwoPi), m.inverse_omega_v = Pack(1.0 / kTwoPi);
  m.H = Pack(row.H), m.y0 = Pack(row.y0);
  GapJet<Pack> start{};
  start.g = Pack(row.g), start.g1 = Pack(row.g1), start.h = Pack(row.h), start.h1 = Pack(row.h1);
  start.state = {Pack(row.phase), Pack(row.X), Pack(row.U), Pack(row.Y), Pack(row.W)};
  FlightBounds<Pack> bounds{};
  bounds.fastest = Pack(row.fastest);
  return Flight<Pack>(m, Pack(row.eta), start, bounds);
}

// The time since the start of the motion of the count-th sample of the grid, with the bits of SampleGrid::time(n) -
// start.
AFM_LANE_INLINE Pack time_in_arc(const lanes::SampleClock& clock, P count) {
  const Pack zero(0.0), one(1.0), period(clock.period);
  const Pack product = count * period, rest = fma(count, period, -product), whole = floor(product);
  const Pack sum = zero + ((product - whole) + rest), more = floor(sum), fraction = sum - more;
  const Mask carried = fraction >= one;
  const Pack tau = (whole + more) + select(carried, one, zero);
  const Pack phase = Pack(clock.origin_phase) + select(carried, zero, fraction);
  const Mask same = phase < one;
  const Pack tau_in_arc = (Pack(clock.origin_tau) + tau) + select(same, zero, one);
  return tau_in_arc + (select(same, phase, phase - one) - Pack(clock.start_phase));
}

// The last pack overlaps the one before it. With fewer samples than lanes, the last sample fills the pack.
template <class At>
AFM_LANE_INLINE double sample_all(const SampleRow& row, const At& at) {
  const lanes::SampleClock clock = row.clock;
  const Pack numbers = Pack(lane_numbers()), last(row.first + static_cast<double>(row.n - 1));
  // a constant, as a call at run time would be a shared function
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Pack lowest(kInfinity);
  double few[2][kLanes];
  double* const vertical = row.n < std::size_t{kLanes} ? few[0] : row.vertical;
  double* const lateral = row.n < std::size_t{kLanes} ? few[1] : row.lateral;
  for (std::size_t i = 0; i < row.n; i += std::size_t{kLanes}) {
    const std::size_t from =
        i + std::size_t{kLanes} <= row.n || row.n < std::size_t{kLanes} ? i : row.n - std::size_t{kLanes};
    const Pack count = min(Pack(row.first + static_cast<double>(from)) + numbers, last);
    const PackDeflection d = at(time_in_arc(clock, count));
    store_row(vertical + from, d.vertical.r);
    store_row(lateral + from, d.lateral.r);
    lowest = min(lowest, d.gap);
  }
  for (std::size_t i = 0; row.n < std::size_t{kLanes} && i < row.n; ++i) {
    row.vertical[i] = few[0][i];
    row.lateral[i] = few[1][i];
  }
  double gaps[kLanes], least = kInfinity;
  store_row(gaps, lowest.r);
  for (const double gap : gaps) least = gap < least ? gap : least;
  return least;
}

AFM_LANE_INLINE double sample(const SampleRow& row) {
  if (!row.on_slide) {
    const Flight<Pack> flight = flight_of(row);
    return sample_all(row, [&](P s) { return flight_deflection(flight, s); });
  }
  Series<Pack> displacement;
  for (std::size_t k = 0; k < displacement.size(); ++k) displacement[k] = Pack(row.displacement[k]);
  const SlidePath<Pack> reference{Pack(row.phase), Pack(row.X), Pack(row.eta), Pack(row.H), Pack(row.y0), displacement};
  return sample_all(row, [&](P s) { return slide_deflection(reference, s); });
}

}  // namespace
}  // namespace afm
