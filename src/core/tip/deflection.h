// What a sample of the deflection is, for a number or for a pack of lanes.
#pragma once

#include "afm/contact.h"
#include "afm/tip.h"
#include "core/lanes/sample_row.h"

namespace afm {

// Of a number a plain branch. A pack (src/core/lanes/pack.h) leaves out a way that none of its numbers goes.
template <class F, class G>
auto branch(bool condition, const F& yes, const G& no) {
  return condition ? yes() : no();
}

// The state and gap of Flight::gap, without the derivatives.
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

// Along a piece of contact, or of the reference slide of a burst.
template <class T>
struct SlidePath {
  T phase, X;  // at its start
  T eta, H, y0;
  const Series<T>& displacement;
};

template <class T>
DeflectionOf<T> slide_deflection(const SlidePath<T>& reference, const T& s) {
  const T d = horner(reference.displacement, s);
  return {surface_jet(reference.H, T(reference.phase + d)).h - reference.y0, reference.X + (d - reference.eta * s), T(0.0)};
}

// What lanes need of an arc, but for which samples.
lanes::SampleRow row_of(const Flight<double>& flight);
lanes::SampleRow row_of(const SlideSegment<double>& slide);

}  // namespace afm
