#include "afm/dynamics/symbolic_dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "afm/dynamics/cycle_expansion.h"
#include "afm/dynamics/orbit_search.h"
#include "support/models.h"

namespace afm {
namespace {

// Never two b in a row, otherwise by chance: as many words of n letters as Fibonacci says, and one forbidden word.
TEST(Words, OfTheGoldenMeanShiftAreCountedAsFibonacciCounts) {
  std::mt19937_64 random(3);
  constexpr double kShare = 0.38;  // of b after an a
  std::string letters = "a";
  while (letters.size() < 400000) {
    const bool b = letters.back() == 'a' && static_cast<double>(random() >> 11) * 0x1p-53 < kShare;
    letters += b ? 'b' : 'a';
  }
  const std::vector<WordCount> counts = count_words(letters, 2, 8);
  const std::size_t fibonacci[] = {2, 3, 5, 8, 13, 21, 34, 55};
  const double a = 1.0 / (1.0 + kShare);  // share of a
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(counts[i].words, fibonacci[i]);
    EXPECT_EQ(counts[i].forbidden.size(), i == 1 ? 1u : 0u) << i;
    if (i < 1) continue;
    const double entropy = -a * (kShare * std::log(kShare) + (1.0 - kShare) * std::log(1.0 - kShare));
    EXPECT_NEAR(counts[i].entropy, entropy, 3e-3) << i;
  }
  EXPECT_EQ(counts[1].forbidden[0], "bb");
}

TEST(Words, OfAnOrbitDoNotDependOnWhereItBegins) {
  const Partition partition{{0.2, 0.6}, {1.0, 2.0}};
  const TipState a{0.3, 0.0, 0.0, 0.0, 0.5}, b{0.3, 0.0, 0.0, 0.0, 1.5}, d{0.1, 0.0, 0.0, 0.0, 2.5};
  EXPECT_EQ(word_of(partition, {d, b, a}), "dba");
  EXPECT_EQ(cyclic_word(partition, {d, b, a}), "adb");
  EXPECT_EQ(cyclic_word(partition, {b, a, d}), "adb");
}

// A partition tells no more than the map makes, and a good one nearly all of it (Pesin: entropy = exponent).
TEST(SymbolicDynamics, AtEta3_2TheWordsTellTheWholeMotion) {
  const SymbolicRun run = run_on_section(PoincareMap(hammer(), 3.2), 300000, 1);
  ASSERT_TRUE(run.on_section);
  const Partition partition = find_partition(run.points);
  ASSERT_EQ(partition.letters(), 4u);
  const std::vector<WordCount> counts = count_words(word_of(partition, run.points), 4, 12);
  for (std::size_t i = 1; i < counts.size(); ++i) EXPECT_LT(counts[i].entropy, counts[i - 1].entropy);
  EXPECT_GT(counts.back().entropy, run.exponent - 4.0 * run.exponent_std_error);
  EXPECT_LT(counts.back().entropy, 1.1 * run.exponent);
  const std::string letters = word_of(partition, run.points);
  EXPECT_LT(word_spread(letters, run.points, 10).mean, 0.6 * word_spread(letters, run.points, 6).mean);
}

TEST(SymbolicDynamics, AtEta3_2OrbitsHaveNamesAndGiveTheFriction) {
  const PoincareMap map(hammer(), 3.2);
  const SymbolicRun run = run_on_section(map, 100000, 1);
  const Partition partition = find_partition(run.points);
  OrbitSearchSettings settings;
  settings.longest = 7;
  settings.trajectory = 50000;
  settings.guesses = 300;
  std::vector<PeriodicOrbit> orbits;
  std::set<std::string> words;
  for (const FoundOrbit& f : search_orbits(map, settings).orbits) {
    if (f.approach > 0.1) continue;  // of the repeller beside the attractor
    orbits.push_back(f.orbit);
    words.insert(cyclic_word(partition, f.orbit.points));
  }
  EXPECT_EQ(words.size(), orbits.size());
  // an eleventh stretches by 1419: few guesses lead to it, and it weighs next to nothing
  const auto moderate = std::count_if(
      orbits.begin(), orbits.end(), [](const PeriodicOrbit& orbit) { return std::abs(orbit.multipliers[0]) < 500.0; });
  EXPECT_EQ(moderate, 10);
  constexpr double kDirect = 0.148786;  // +- 3e-5, over 4e5 tau
  EXPECT_NEAR(zeta_averages(orbits, 3.2, 7).back().K_f, kDirect, 0.01 * kDirect);
}

TEST(SymbolicDynamics, TheErrorOfTheExponentIsItsSpreadOverSeeds) {
  constexpr std::uint64_t kSeeds = 10;
  double sum = 0.0, squares = 0.0, errors = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SymbolicRun run = run_on_section(PoincareMap(hammer(), 3.2), 20000, seed);
    sum += run.exponent;
    squares += run.exponent * run.exponent;
    errors += run.exponent_std_error * run.exponent_std_error;
  }
  const double variance = (squares - sum * sum / kSeeds) / (kSeeds - 1);
  EXPECT_NEAR(std::sqrt(errors / kSeeds / variance), 1.0, 0.6);
}

// A map that settles into contact has no section to cut.
TEST(SymbolicDynamics, SaysWhereThereIsNone) {
  EXPECT_FALSE(run_on_section(PoincareMap(hammer(0.7, 0.0), 0.0), 100000, 1).on_section);
}

}  // namespace
}  // namespace afm
