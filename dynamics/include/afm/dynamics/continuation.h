// Continuation of a periodic orbit in a parameter, around folds, up to its birth or death. It finds the bifurcations on
// the way (paper, section VII: period doubling, grazing). Natural units.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/model.h"
#include "periodic_orbit.h"

namespace afm {

enum class Parameter : std::uint8_t { eta, gamma, cutoff };

struct BranchPoint {
  double parameter = 0.0;
  PeriodicOrbit orbit;
};

enum class BifurcationKind : std::uint8_t {
  saddle_node,      // a multiplier passes 1: the branch turns back
  period_doubling,  // a multiplier passes -1
  torus,            // a pair passes the unit circle: an invariant circle is born or dies
  corner,  // the normal speed of an impact passes the cutoff, where the slope of the law and the multipliers jump
  grazing  // a flight touches the surface on its way: the orbit ends
};

const char* name(BifurcationKind kind);

struct BranchEvent {
  BifurcationKind kind;
  BranchPoint at;
  double turns = 0.0;  // torus: argument of the pair [turns]; 0, 1/2, 1/3 and 1/4 are strong resonances
};

enum class BranchEnd : std::uint8_t {
  target,           // the target is reached
  grazing,          // the orbit ends in a grazing
  period_doubling,  // a step further it is born from an orbit half as long
  resonance,        // the horizontal spring turns a whole number of times in a period: the extension diverges
  lost,             // no step leads on, however small
  steps_spent       // the step limit came first
};

struct Branch {
  std::vector<BranchPoint> points;
  std::vector<BranchEvent> events;
  BranchEnd end = BranchEnd::lost;
};

// From `start` until the varied parameter reaches `target`. Precondition: `start` is an orbit of `model` at `eta`.
Branch continue_orbit(const Model& model, double eta, const PeriodicOrbit& start, Parameter vary, double target);

}  // namespace afm
