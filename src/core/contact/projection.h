// From a bouncing tip to the reference slide, the slide that it would make without bouncing, and back. For numbers and
// for dual numbers. `free`: 1, or 0 for the hammer, which is held along x.
#pragma once

#include <cmath>

#include "afm/detail/chatter.h"
#include "afm/detail/slide_segment.h"
#include "afm/surface.h"

namespace afm::detail {

// The state after a bounce: phase [a], extension [a], lab velocity [a/tau] and gap rate [a/tau].
template <class T>
struct BounceState {
  T phase, X, u, g1;
};

// Takes the normal velocity out. The tangential velocity stays.
template <class T>
inline ProjectionOf<T> projected(const T& free, const T& H, const BounceState<T>& state) {
  using std::sqrt;
  const T slope = free * surface_jet(H, state.phase).h1, N2 = T(1.0) + slope * slope, N = sqrt(N2);
  const T u = state.u + slope * state.g1 / N2;
  return {{state.phase, state.X, u}, state.g1 / N, u * N};
}

// Puts a normal velocity back.
template <class T>
inline BounceState<T> launched(const T& free, const T& H, const SlideState<T>& reference, const T& normal_speed) {
  using std::sqrt;
  const T slope = free * surface_jet(H, reference.phase).h1, N = sqrt(T(1.0) + slope * slope);
  return {reference.phase, reference.X, reference.u - slope * normal_speed / N, normal_speed * N};
}

// The reference slide, displaced by sigma along the surface, and faster by p along it.
template <class T>
inline SlideState<T> displaced_reference_of(const T& H, const SlideState<T>& reference, const ChatterOf<T>& chatter) {
  using std::sqrt;
  const auto N = [&](const T& phase) {
    const T slope = surface_jet(H, phase).h1;
    return T(sqrt(T(1.0) + slope * slope));
  };
  const T here = N(reference.phase), dx = chatter.sigma / here, phase = reference.phase + dx;
  return {phase, reference.X + dx, (reference.u * here + chatter.p) / N(phase)};
}

}  // namespace afm::detail
