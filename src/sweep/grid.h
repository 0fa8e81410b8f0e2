// The points of a curve or map, in the order of the rows of its table: eta changes fastest, then gamma, cutoff, rest
// height, amplitude and frequency ratio.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "afm/sweep.h"

namespace afm {

// Fresh: each point from a random start of its own. Up, down: each from where the eta before it ended, so that a tip
// stays on its attractor while there is one.
enum class SweepDirection { fresh, up, down };
bool parse(const std::string& name, SweepDirection& direction);  // false where the name is of none

struct CurveSettings {
  std::vector<double> eta, gamma, cutoff;  // eta rises strictly where one point starts from another
  std::vector<double> rest_height{Model{}.y0}, amplitude{Model{}.H}, frequency_ratio{Model{}.frequency_ratio};
  SweepDirection direction = SweepDirection::fresh;
  ModelKind model = ModelKind::oscillator;
  SweepSettings sweep;
  SweepMethod method = sweep_point;

  std::size_t size() const;
  // Points that must be done one after the other: a whole row of etas, or one.
  std::size_t chain_length() const { return direction == SweepDirection::fresh ? 1 : eta.size(); }
  SweepPoint at(std::size_t position) const;
};

// Every fault of the settings, and the first ten of the points; under the names of the command line.
std::vector<ParameterError> find_faults(const CurveSettings& settings);

// What can be run, but is seldom meant, once for each frequency ratio; under the names of the command line.
std::vector<ParameterError> find_warnings(const CurveSettings& settings);

// In one line all that the table depends on, and nothing else.
std::string identity(const CurveSettings& settings);

// The results of the chain that begins at this position: each point starts where the point before it ended. A result
// depends on the point and its start alone. Counts each point in `done`, for whoever shows the progress.
std::vector<SweepResult> compute_chain(const CurveSettings& settings, std::size_t begin,
                                       std::atomic<std::size_t>& done);

}  // namespace afm
