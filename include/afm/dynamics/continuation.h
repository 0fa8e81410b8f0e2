// A periodic orbit followed through a parameter, around folds, to where it is born or dies, with the bifurcations on
// its way.
#pragma once

#include <cstdint>
#include <functional>
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
  saddle_node,      // a multiplier passes 1: the branch turns round
  period_doubling,  // a multiplier passes -1
  torus,            // a pair passes the unit circle: an invariant circle is born or dies
  corner,  // an impact's normal speed passes the cutoff, where the slope of the law jumps, and multipliers with it
  grazing  // a flight touches the surface on its way: the orbit is no more
};

const char* name(BifurcationKind kind);

struct BranchEvent {
  BifurcationKind kind;
  BranchPoint at;
  double turns = 0.0;  // torus: argument of the pair, in turns; at 0, 1/2, 1/3 and 1/4 more happens than a circle
};

enum class BranchEnd : std::uint8_t {
  target,     // the parameter asked for is reached
  grazing,    // the orbit has ended in an event of that kind
  resonance,  // the horizontal spring comes to turn whole times in a period: the extension grows beyond all bounds
  lost,       // no step, however small, leads on; the last points tell why
  steps_spent
};

struct Branch {
  std::vector<BranchPoint> points;
  std::vector<BranchEvent> events;
  BranchEnd end = BranchEnd::lost;
};

struct ContinuationSettings {
  double first_step = 1e-3,
         largest_step = 2e-2;  // of the arclength: parameter, a, a/tau (divided by 1 + |eta|) together
  int most_steps = 2000;
  double event_tolerance = 1e-10;  // of the parameter at an event
};

// From `start`, an orbit of `model` at `eta`, until the varied parameter reaches `target`. Precondition: `start` is
// one.
Branch continue_orbit(const Model& model, double eta, const PeriodicOrbit& start, Parameter vary, double target,
                      const ContinuationSettings& settings = {});

// The map at a value of the varied parameter.
PoincareMap map_at(const Model& model, double eta, Parameter vary, double value);
double value_of(const Model& model, double eta, Parameter parameter);

}  // namespace afm
