// Exact flight (Eq. 9-10 of the paper) and the gap along it. Times s count from the start of the flight [tau]. The
// extensions X = x - xc and Y = y - y0 rotate with U = u - eta and W = w, each pair by the angle of its spring.
// Guarantees: the rounding of the gap is bounded by gap_error() (Lemma 7 of docs/algorithm.md), and no energy drifts.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/detail/flight_bounds.h"
#include "afm/detail/flight_jets.h"
#include "model.h"
#include "spring_constants.h"
#include "state.h"
#include "surface.h"

namespace afm {

template <class T>
class Flight {
 public:
  Flight(const SpringConstants<T>& springs, const T& eta, const TipState& start)
      : m_(springs), eta_(eta), launch_(start), start_(detail::jet_at_launch(springs, eta, start)) {
    detail::bound_flight(springs, eta, start_.state, bounds_);
  }

  // Error: a few ulp of the larger terms; for small turns, a few ulp of the change since the start.
  GapJet<T> gap(const T& s) const {
    return detail::is_small(bounds_, s) ? detail::advance_jet(m_, eta_, start_, s) : detail::jet_at(m_, eta_, at(s));
  }
  // The state s tau after the start.
  FlightState<T> at(const T& s) const { return detail::state_after(m_, eta_, start_.state, s); }

  TipState tip_state(const T& s) const;  // the same as that of a tip

  // Bound of the rounding error of gap(s).g [a] (Lemma 7).
  T gap_error(const T& s) const;

  const TipState& launch() const { return launch_; }  // the state it began with, as given
  const GapJet<T>& start() const { return start_; }
  const T& eta() const { return eta_; }
  const SpringConstants<T>& springs() const { return m_; }

 private:
  friend const detail::FlightBounds<T>& detail::bounds_of<T>(const Flight& flight);  // for the search

  SpringConstants<T> m_;
  T eta_;
  TipState launch_;
  GapJet<T> start_;
  detail::FlightBounds<T> bounds_;
};

template <class T>
TipState Flight<T>::tip_state(const T& s) const {
  const GapJet<T> jet = gap(s);
  const T u = eta_ + jet.state.U;
  return {wrap_phase(static_cast<double>(jet.state.phase)), static_cast<double>(jet.state.X), static_cast<double>(u),
          static_cast<double>(jet.g), static_cast<double>(jet.g1)};
}

template <class T>
T Flight<T>::gap_error(const T& s) const {
  using std::abs;
  using std::max;
  constexpr double kOfChange = 8.0, kOfHeight = 4.0, kOfSurface = 16.0, kOfExtension = 32.0;  // [ulp] Lemma 7
  constexpr double kOfLaunch = 1.5;  // [ulp tau/a] the vertical velocity at the launch, where g1 and h' u cancel
  const T ulp = detail::epsilon<T>();
  if (detail::is_small(bounds_, s)) {
    return ulp * (start_.g + T(kOfChange) * s * (abs(start_.g1) + bounds_.second * s));
  }
  const T launch = T(kOfLaunch) * abs(eta_ + start_.state.U);
  return ulp * (T(kOfHeight) * bounds_.Y + max(max(T(kOfSurface), launch), T(T(kOfExtension) * bounds_.X)) * m_.H);
}

}  // namespace afm
