// One point of a friction curve: the friction along the orbit of a start (Eq. 1 and 6-8 of the paper). Natural units.
// src/sweep/ computes curves of such points.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "afm/model.h"
#include "afm/state.h"
#include "bath.h"
#include "time_average.h"

namespace afm {

struct SweepPoint {
  double eta, gamma, v_c;  // [a/tau], [-], [a/tau]
  ModelKind kind = ModelKind::oscillator;
  double y0 = Model{}.y0, H = Model{}.H;  // [a]
  double frequency_ratio = Model{}.frequency_ratio;
};

struct SweepSettings {
  double duration = 10000.0;  // of the measurement [tau]
  double transient = 1000.0;  // before it [tau]
  std::uint64_t seed = 1;     // of the starts drawn at random
  Bath bath;                  // off; every point uses its own stream of the bath's seed
};

struct SweepResult {
  FrictionAverage friction;
  std::string attractor = "unknown";                                   // with a bath: thermal
  double largest_lyapunov = std::numeric_limits<double>::quiet_NaN();  // [1/tau]; NaN where it was not measured
  TipState end;                                                        // of the orbit: the next point may begin here
};

// Every fault of the set.
std::vector<ParameterError> find_faults(const SweepPoint& point);
std::vector<ParameterError> find_faults(const SweepSettings& settings);

// The fault of a table of so many points, if they are more than a million.
std::vector<ParameterError> find_point_count_fault(double points);

// Warnings, named as the faults: those of a bath (bath.h); and a drag over so little of the surface that K_f is that of
// one place: over less than ten times the sum of a lattice spacing and the longest extension of the lateral spring.
std::vector<ParameterError> find_warnings(const SweepPoint& point, const Bath& bath);
std::vector<ParameterError> find_warnings(const SweepPoint& point, const SweepSettings& settings);
// So named, if the holder passes fewer than so many lattice spacings in this duration [tau]; never without a drag.
std::vector<ParameterError> find_short_drag(const char* name, double duration, double eta, double spacings);

Model model_of(const SweepPoint& point);  // its parameters, without the drag

// The start of the index-th point: above the surface, at a random phase, with velocities of the order of the drag
// velocity. Guarantee: a function of seed and index, so points can be computed in any order.
TipState random_start(const SweepPoint& point, std::uint64_t seed, std::uint64_t index);

// An average over time. sweep_attractor() of afm/dynamics/sweep.h knows the attractor: it gives its name and exponent,
// and is exact where the orbit is periodic. Guarantee: a function of its arguments, to the last bit. Precondition: no
// faults.
SweepResult sweep_point(const SweepPoint& point, const SweepSettings& settings, const TipState& start);
using SweepMethod = SweepResult (*)(const SweepPoint&, const SweepSettings&, const TipState&);

}  // namespace afm
