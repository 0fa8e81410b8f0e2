// All periodic orbits up to a length that a search finds, with what speaks for there being no more.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "periodic_orbit.h"

namespace afm {

struct OrbitSearchSettings {
  int longest = 6;          // [impacts]
  int trajectory = 200000;  // impacts of a long run, in which guesses are looked for
  int guesses = 3000;       // for each length and each kind of guess
  std::uint64_t seed = 1;
  NewtonSettings newton;
};

struct FoundOrbit {
  PeriodicOrbit orbit;
  int times_found = 0;    // from different guesses
  double approach = 0.0;  // nearest that the long run comes to its first point: small on the attractor [a, a/tau]
};

// Of one length. Guesses that led to an orbit of that length, to repeats of shorter ones, or to none.
struct LengthReport {
  int length = 0;
  int prime = 0, repeats = 0, none = 0;
  double closest_return = 0.0;  // of the long run to itself, repeats of shorter orbits and all [a, a/tau]
  // How many orbits of this length the guesses may have missed, from how many were found once, f1, and twice, f2:
  // f1 (f1 - 1) / (2 (f2 + 1)) (Chao).
  double missed = 0.0;
};

struct OrbitSearchResult {
  std::vector<FoundOrbit> orbits;  // prime, by length and then by friction
  std::vector<LengthReport> lengths;
};

// Newton's method from the nearest returns of a long run, from pieces of it taken at random, and from pieces of runs
// begun anywhere; `progress` is called with the share done. The same orbits for the same seed.
OrbitSearchResult search_orbits(const PoincareMap& map, const OrbitSearchSettings& settings,
                                const std::function<void(double)>& progress = {});

}  // namespace afm
