// Symbolic dynamics of the hammer: its map of two dimensions, phase and gap rate after an impact, cut into pieces that
// are named by letters; which words of letters occur, and how much of the motion they tell.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "poincare_map.h"
#include "afm/state.h"

namespace afm {

// A run of the map on its attractor, with its largest exponent.
struct SymbolicRun {
  bool on_section = true;        // false: it ended in contact, or found no impact; `points` are those up to there
  std::vector<TipState> points;  // after each impact
  double exponent = 0.0;         // natural logarithm of the stretching of an impact
  double exponent_std_error = 0.0;
};
SymbolicRun run_on_section(const PoincareMap& map, std::size_t impacts, std::uint64_t seed);

// The bands of the attractor, parted by phases that it leaves out, each cut in two at one gap rate, where the map folds
// it.
struct Partition {
  std::vector<double> begins;  // phase at which each band begins, rising
  std::vector<double> cuts;    // gap rate in each: below it the first letter of the two, above it the second [a/tau]

  char letter(const TipState& point) const;
  std::size_t letters() const { return 2 * cuts.size(); }
};

// Bands from gaps in phase wider than `gap`; cuts by trial, so that words of ten letters leave the least unsaid
// (word_spread).
Partition find_partition(const std::vector<TipState>& points, double gap = 0.05);

std::string word_of(const Partition& partition, const std::vector<TipState>& points);

// Of a periodic orbit: the same whichever point it begins with (the first in the alphabet's order).
std::string cyclic_word(const Partition& partition, const std::vector<TipState>& points);

struct WordCount {
  int length = 0;
  std::size_t words = 0;               // different ones that occur
  std::vector<std::string> forbidden;  // that do not, though all their parts do: what the alphabet is pruned by
  double entropy = 0.0;                // of a letter, given the length - 1 before it: natural logarithm
};

// What a word leaves unsaid of the point at its middle: rms of the gap rate within the points of one word, and in the
// word that says least; over the rms of all [1]. Both go to 0 with the length where the partition separates points
// (it generates).
struct WordSpread {
  double mean, largest;
};
WordSpread word_spread(const std::string& letters, const std::vector<TipState>& points, int length);

// Of every length up to `longest`. A word counts as one that occurs when it does once in the run: the run must be long
// against the number of words.
std::vector<WordCount> count_words(const std::string& letters, std::size_t alphabet, int longest);

}  // namespace afm
