// A sweep takes a parameter over a range, point by point. This is one point of it: the attractor that a start leads to, and
// the friction on it. Natural units. src/sweep/ makes curves of such points; the scene `sweep` takes the drag velocity of a
// running emulator over a range.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/bath.h"
#include "afm/model.h"
#include "afm/state.h"
#include "attractor.h"
#include "time_average.h"

namespace afm {

struct SweepPoint {
  double eta, gamma, v_c;
  ModelKind kind = ModelKind::oscillator;
  double y0 = Model{}.y0, H = Model{}.H, frequency_ratio = Model{}.frequency_ratio;
};

struct SweepSettings {
  double duration = 10000.0;  // of the measurement [tau]
  double transient = 1000.0;  // before it [tau]
  std::uint64_t seed = 1;     // of the starts drawn at random
  Bath bath;                  // none; its own seed and a stream for every point
};

struct SweepResult {
  FrictionAverage friction;
  Attractor attractor;  // with a bath there is none to be found: thermal, exponents NaN
  TipState end;         // of the orbit, for the next point to begin with
};

// Every fault of the set.
std::vector<ParameterError> find_faults(const SweepPoint& point);
std::vector<ParameterError> find_faults(const SweepSettings& settings);

Model model_of(const SweepPoint& point);

// The start of the index-th point: above the surface, at a random phase, with a velocity of the order of the drag's. A
// function of seed and index alone, so that points can be computed in any order.
TipState random_start(const SweepPoint& point, std::uint64_t seed, std::uint64_t index);

// A function of its arguments alone, to the last bit. Precondition: no faults.
SweepResult sweep_point(const SweepPoint& point, const SweepSettings& settings, const TipState& start);

}  // namespace afm
