// Symbolic dynamics of the hammer (sections VIII and IX of the paper). Its map has two dimensions, phase and gap rate
// after an impact. A partition names regions of the section by letters. We count which words occur, and how well they
// determine the motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "afm/state.h"
#include "poincare_map.h"

namespace afm {

// A run of the map on its attractor, with its largest exponent.
struct SymbolicRun {
  bool on_section = true;        // false: it ended in contact or without an impact; `points` are those before
  std::vector<TipState> points;  // after each impact
  double exponent = 0.0;         // natural logarithm of the stretching of an impact
  double exponent_std_error = 0.0;
};
SymbolicRun run_on_section(const PoincareMap& map, std::size_t impacts, std::uint64_t seed);

// The bands of the attractor, separated by gaps in phase. Each band is cut in two at the gap rate at which the map
// folds it.
struct Partition {
  std::vector<double> begins;  // phase at which each band begins, rising
  std::vector<double> cuts;    // gap rate in each: below it the first letter of the two, above it the second [a/tau]

  char letter(const TipState& point) const;
  std::size_t letters() const { return 2 * cuts.size(); }
};

// Bands from gaps in phase wider than `gap`. The cuts minimize word_spread() of words of ten letters.
Partition find_partition(const std::vector<TipState>& points, double gap = 0.05);

std::string word_of(const Partition& partition, const std::vector<TipState>& points);

// The word of a periodic orbit: the first rotation in alphabetical order, so it does not depend on the first point.
std::string cyclic_word(const Partition& partition, const std::vector<TipState>& points);

struct WordCount {
  int length = 0;
  std::size_t words = 0;               // different ones that occur
  std::vector<std::string> forbidden;  // do not occur although all their parts do: the pruning rules
  double entropy = 0.0;                // of a letter, given the length - 1 letters before it (natural logarithm)
};

// How well a word determines the point at its middle: the rms of the gap rate among the points of one word over the rms
// of all points, as a mean and for the worst word. Both go to 0 with the length if the partition is generating.
struct WordSpread {
  double mean, largest;
};
WordSpread word_spread(const std::string& letters, const std::vector<TipState>& points, int length);

// Counts words of every length up to `longest`. A word occurs if it is found once. Precondition: the run is long
// against the number of words.
std::vector<WordCount> count_words(const std::string& letters, std::size_t alphabet, int longest);

}  // namespace afm
