// The attractors at given parameters (paper, section VII), and the part of random starts that leads to each. Natural
// units.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/sweep.h"
#include "attractor.h"

namespace afm {

struct BasinSettings {
  int starts = 200;  // random_start() of sweep.h: above the surface, velocities of the order of the drag's
  std::uint64_t seed = 1;
  std::vector<FreeState> given;       // starts in place of the random ones, if there are any
  double friction_duration = 1000.0;  // of the measurement of K_f at each start [tau]
  AttractorSettings attractor;
};

// One start and its attractor.
struct Visit {
  Attractor attractor;
  double K_f = 0.0, K_f_std_error = 0.0;  // [m_tip/tau]
  TipState start;
};

struct Basin {
  Visit first;                                // the first start that led here
  std::vector<int> starts;                    // numbers of the starts that led here
  double share = 0.0, share_std_error = 0.0;  // of all starts; binomial
};

// The index-th start at this point: given, or random.
TipState start_of(const SweepPoint& point, std::uint64_t index, const BasinSettings& settings);
// Where that start leads.
Visit visit(const SweepPoint& point, std::uint64_t index, const BasinSettings& settings);

// Two visits belong to one attractor if kind, impacts and cells agree, and K_f within five standard errors or 1e-6.
bool same_attractor(const Visit& a, const Visit& b);

// Largest basin first. Precondition: no faults in the point.
std::vector<Basin> find_basins(const SweepPoint& point, const BasinSettings& settings);

}  // namespace afm
