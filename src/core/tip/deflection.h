// A sample of the deflection, for a number or for a pack of lanes.
#pragma once

#include "afm/contact.h"
#include "afm/tip.h"
#include "core/lanes/sample_row.h"

namespace afm {

// For a number: a plain branch. A pack (src/core/lanes/pack.h) has its own, which skips a side that no lane takes.
template <class F, class G>
auto branch(bool condition, const F& yes, const G& no) {
  return condition ? yes() : no();
}

// The same as Flight::gap, without the derivatives.
template <class T>
DeflectionOf<T> flight_deflection(const Flight<T>& flight, const T& s) {
  const auto near = [&] {
    const GapJet<T> jet = flight.gap_by_small_turns(s);
    return DeflectionOf<T>{jet.state.Y, jet.state.X, jet.g};
  };
  const auto far = [&] {
    const FlightState<T> q = flight.at(s);
    const Mechanics<T>& m = flight.mechanics();
    return DeflectionOf<T>{q.Y, q.X, q.Y + m.y0 - surface_jet(m.H, q.phase).h};
  };
  return branch(flight.is_small(s), near, far);
}

// A Taylor series of a slide in contact, or of the reference slide.
template <class T>
struct SlidePath {
  T phase, X;  // at its start
  T eta, H, y0;
  const Series<T>& displacement;
};

template <class T>
DeflectionOf<T> slide_deflection(const SlidePath<T>& reference, const T& s) {
  const T d = horner(reference.displacement, s);
  return {surface_jet(reference.H, T(reference.phase + d)).h - reference.y0, reference.X + (d - reference.eta * s),
          T(0.0)};
}

// The motion as the lanes need it; the caller adds the samples.
lanes::SampleRow row_of(const Flight<double>& flight);
lanes::SampleRow row_of(const SlidePath<double>& reference);

}  // namespace afm
