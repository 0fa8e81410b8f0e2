// A search for all periodic orbits up to a length (paper, section VIII), with an estimate of how many it has missed.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "periodic_orbit.h"

namespace afm {

struct OrbitSearchSettings {
  int longest = 6;          // [impacts]
  int trajectory = 200000;  // impacts of the long run that gives first estimates
  int guesses = 3000;       // first estimates for each length and each kind
  std::uint64_t seed = 1;
};

struct FoundOrbit {
  PeriodicOrbit orbit;
  int times_found = 0;    // from different first estimates
  double approach = 0.0;  // smallest distance of the long run from its first point: small on the attractor [a, a/tau]
};

// The search for orbits of one length: how many first estimates led to an orbit of that length, to a repeated shorter
// orbit, or to none.
struct LengthReport {
  int length = 0;
  int prime = 0, repeats = 0, none = 0;
  double closest_return = 0.0;  // of the long run to itself, shorter orbits included [a, a/tau]
  // Estimated number of orbits not found, from the numbers found once, f1, and twice, f2: f1 (f1 - 1) / (2 (f2 + 1))
  // (Chao).
  double missed = 0.0;
};

struct OrbitSearchResult {
  std::vector<FoundOrbit> orbits;  // prime, by length and then by friction
  std::vector<LengthReport> lengths;
};

// Newton's method from the nearest returns of a long run, from random parts of it, and from runs with random starts.
// `progress` is called with the part done. Guarantee: the same orbits for the same seed.
OrbitSearchResult search_orbits(const PoincareMap& map, const OrbitSearchSettings& settings,
                                const std::function<void(double)>& progress = {});

}  // namespace afm
