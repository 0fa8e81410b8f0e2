#include "afm/dynamics/symbolic_dynamics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string_view>

#include "core/run/batch_means.h"

namespace afm {

using namespace detail;

namespace {

constexpr int kTransient = 1000;  // [impacts] a choice

// Maps a displacement and normalizes it; returns the logarithm of its growth.
double map_displacement(const SectionJacobian<double>& J, Eigen::Vector4d& displacement) {
  displacement = (J * displacement).eval();
  const double length = displacement.norm();
  displacement /= length;
  return std::log(length);
}

using Counts = std::map<std::string_view, std::size_t>;

Counts count(std::string_view letters, std::size_t length) {
  Counts counts;
  for (std::size_t i = 0; i + length <= letters.size(); ++i) ++counts[letters.substr(i, length)];
  return counts;
}

double entropy(const Counts& counts) {
  double total = 0.0, sum = 0.0;
  for (const auto& word : counts) total += static_cast<double>(word.second);
  for (const auto& word : counts) {
    const double share = static_cast<double>(word.second) / total;
    sum -= share * std::log(share);
  }
  return sum;
}

// Words that are one letter longer than those of `shorter` and do not occur, although both ends do.
std::vector<std::string> missing(const Counts& shorter, const Counts& longer, std::size_t alphabet) {
  std::vector<std::string> words;
  for (const auto& head : shorter) {
    for (std::size_t k = 0; k < alphabet; ++k) {
      const std::string word = std::string(head.first) + static_cast<char>('a' + k);
      const bool tail_occurs = shorter.count(std::string_view(word).substr(1)) != 0;
      if (tail_occurs && longer.count(word) == 0) words.push_back(word);
    }
  }
  return words;
}

// Running sum of squared deviations from the mean (Welford).
struct Moments {
  double count = 0.0, mean = 0.0, squares = 0.0;

  void add(double x) {
    count += 1.0;
    const double step = x - mean;
    mean += step / count;
    squares += step * (x - mean);
  }
};

// Phases at which bands begin: after each gap that is wide enough.
std::vector<double> band_begins(const std::vector<TipState>& points, double gap) {
  std::vector<double> phases, begins;
  for (const TipState& p : points) phases.push_back(p.phase);
  std::sort(phases.begin(), phases.end());
  double before = phases.back() - 1.0;
  for (const double phase : phases) {
    if (phase - before > gap) begins.push_back(phase);
    before = phase;
  }
  if (begins.empty()) begins.push_back(0.0);
  return begins;
}

std::size_t band(const std::vector<double>& begins, double phase) {
  const auto after = std::upper_bound(begins.begin(), begins.end(), phase);
  return after == begins.begin() ? begins.size() - 1 : static_cast<std::size_t>(after - begins.begin()) - 1;
}

double unresolved_spread(const Partition& partition, const std::vector<TipState>& points) {
  constexpr int kLetters = 10;  // a choice: with 40000 points the 2^10 words have 40 points each
  return word_spread(word_of(partition, points), points, kLetters).mean;
}

// The cut of one band that leaves least unsaid, the others as they are.
void improve(Partition& partition, std::size_t k, const std::vector<TipState>& points) {
  constexpr std::size_t kTrials = 50;  // a choice: cuts to 2 % of the width of a band
  std::vector<double> rates;
  for (const TipState& p : points) {
    if (band(partition.begins, p.phase) == k) rates.push_back(p.g1);
  }
  if (rates.empty()) return;
  std::sort(rates.begin(), rates.end());
  double best = INFINITY, best_cut = partition.cuts[k];
  for (std::size_t i = 1; i < kTrials; ++i) {
    partition.cuts[k] = rates.front() + (rates.back() - rates.front()) * static_cast<double>(i) / kTrials;
    const double value = unresolved_spread(partition, points);
    if (value < best) best = value, best_cut = partition.cuts[k];
  }
  partition.cuts[k] = best_cut;
}

}  // namespace

SymbolicRun run_on_section(const PoincareMap& map, std::size_t impacts, std::uint64_t seed) {
  SymbolicRun run;
  std::mt19937_64 random(seed);
  const double share = static_cast<double>(random() >> 11) * 0x1p-53, speed = 1.0 + std::abs(map.eta());
  TipState now{share, 0.0, map.eta(), 0.0, 0.5 * speed};
  Eigen::Vector4d displacement(1.0, 0.0, 0.0, 1.0);
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < kTransient + impacts; ++i) {
    const MapStep step = map(now);
    if (step.outcome != MapOutcome::impact) {
      run.on_section = false;
      break;
    }
    now = step.after;
    const double logarithm = map_displacement(step.J, displacement);
    if (i < kTransient) continue;
    logarithms.push_back(logarithm);
    run.points.push_back(now);
  }
  for (const double x : logarithms) run.exponent += x / static_cast<double>(logarithms.size());
  std::vector<double> batches(kTimeBatches, 0.0);
  const std::size_t width = logarithms.size() / kTimeBatches;
  for (std::size_t i = 0; i < width * kTimeBatches; ++i)
    batches[i / width] += logarithms[i] / static_cast<double>(width);
  if (width > 0) run.exponent_std_error = mean_error(std::move(batches)).std_error;
  return run;
}

char Partition::letter(const TipState& point) const {
  const std::size_t k = band(begins, point.phase);
  return static_cast<char>('a' + 2 * k + (point.g1 > cuts[k] ? 1 : 0));
}

Partition find_partition(const std::vector<TipState>& points, double gap) {
  constexpr std::size_t kEnough = 40000;  // points for the cuts, see kLetters
  constexpr int kRounds = 2;              // a choice: a second round accounts for the cuts of the other bands
  const std::vector<TipState> some(points.begin(),
                                   points.begin() + static_cast<std::ptrdiff_t>(std::min(kEnough, points.size())));
  Partition partition;
  if (some.empty()) return partition;
  partition.begins = band_begins(points, gap);
  partition.cuts.assign(partition.begins.size(), 0.0);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < partition.cuts.size(); ++k) improve(partition, k, some);
  }
  return partition;
}

std::string word_of(const Partition& partition, const std::vector<TipState>& points) {
  std::string word;
  for (const TipState& p : points) word += partition.letter(p);
  return word;
}

std::string cyclic_word(const Partition& partition, const std::vector<TipState>& points) {
  std::string word = word_of(partition, points), first = word;
  for (std::size_t i = 1; i < word.size(); ++i) {
    std::rotate(word.begin(), word.begin() + 1, word.end());
    first = std::min(first, word);
  }
  return first;
}

WordSpread word_spread(const std::string& letters, const std::vector<TipState>& points, int length) {
  const auto n = static_cast<std::size_t>(length);
  std::map<std::string_view, Moments> words;
  Moments all;
  for (std::size_t i = 0; i + n <= letters.size(); ++i) {
    const double rate = points[i + n / 2].g1;
    words[std::string_view(letters).substr(i, n)].add(rate);
    all.add(rate);
  }
  double within = 0.0, largest = 0.0;
  for (const auto& word : words) {
    within += word.second.squares;
    largest = std::max(largest, word.second.squares / word.second.count);
  }
  return {std::sqrt(within / all.squares), std::sqrt(largest * all.count / all.squares)};
}

std::vector<WordCount> count_words(const std::string& letters, std::size_t alphabet, int longest) {
  std::vector<WordCount> rows;
  Counts shorter{{std::string_view(), 1}};
  double before = 0.0;
  for (int n = 1; n <= longest; ++n) {
    Counts longer = count(letters, static_cast<std::size_t>(n));
    const double now = entropy(longer);
    rows.push_back({n, longer.size(), missing(shorter, longer, alphabet), now - before});
    before = now;
    shorter = std::move(longer);
  }
  return rows;
}

}  // namespace afm
