#include "afm/dynamics/lyapunov.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "afm/dynamics/tangents.h"
#include "core/not_numbers.h"
#include "core/run/interruptible_advance.h"

namespace afm {
namespace {

constexpr std::size_t kGrowthBatches = 32;  // a choice: the standard error has an error of 13 %, 1/sqrt(2 * 31)

// Sums over equal batches of time.
class Growth {
 public:
  void add(double age, double duration, const EventGrowth& event) {
    const double share = std::fmin(age / duration, 1.0 - 1e-9);
    std::array<double, 4>& batch = batches_[static_cast<std::size_t>(share * static_cast<double>(kGrowthBatches))];
    for (std::size_t i = 0; i < 4; ++i) batch[i] += event.logarithms[i];
    volume_ += event.volume;
  }

  void finish(const Model& model, LyapunovSpectrum& s) const {
    const double n = static_cast<double>(kGrowthBatches), width = s.duration / n;
    for (std::size_t i = 0; i < 4; ++i) {
      double sum = 0.0, squares = 0.0;
      for (const auto& batch : batches_) sum += batch[i];
      for (const auto& batch : batches_) squares += (batch[i] - sum / n) * (batch[i] - sum / n);
      const bool finite = static_cast<int>(i) < s.rank;
      s.exponents[i] = finite ? sum / s.duration : -kInfinity;
      if (s.outcome == LyapunovOutcome::measured) {
        s.std_errors[i] = finite ? std::sqrt(squares / (n - 1.0) / n) / width : 0.0;
      }
    }
    s.volume_rate = s.rank < section_dimension(model) ? -kInfinity : volume_ / s.duration;
  }

 private:
  std::array<std::array<double, 4>, kGrowthBatches> batches_{};
  double volume_ = 0.0;
};

bool has_numbers(const LyapunovSpectrum& s) {
  return std::none_of(s.exponents.begin(), s.exponents.end(), [](double x) { return std::isnan(x); });
}

// Close ones of a finite run may come in another order than their directions.
void sort(LyapunovSpectrum& s) {
  std::array<std::pair<double, double>, 4> both;
  for (std::size_t i = 0; i < 4; ++i) both[i] = {s.exponents[i], s.std_errors[i]};
  std::stable_sort(both.begin(), both.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < 4; ++i) std::tie(s.exponents[i], s.std_errors[i]) = both[i];
}

// Advances by `time`. False if the budget or a failed search came first.
bool skip(Tip& tip, double time, std::uint64_t most_events, LyapunovSpectrum& s) {
  const ModelTime end = tip.now() + time;
  while (tip.now() < end && s.events < most_events) {
    if (detail::advance_interruptibly(tip, end) == Outcome::search_failed) {
      s.outcome = LyapunovOutcome::search_failed;
      return false;
    }
    ++s.events;
  }
  if (s.events >= most_events) s.outcome = LyapunovOutcome::budget_spent;
  return s.events < most_events;
}

}  // namespace

LyapunovSpectrum lyapunov(const Model& model, Tip& tip, const LyapunovSettings& settings) {
  LyapunovSpectrum s;
  if (!skip(tip, settings.transient, settings.most_events, s)) return s;
  Tangents tangents(model, tip);
  if (!tangents.start(settings.duration)) return s;
  const ModelTime begin = tip.now(), end = begin + settings.duration;
  Growth growth;
  s.outcome = LyapunovOutcome::measured;
  while (tip.now() < end && s.outcome == LyapunovOutcome::measured) {
    const Outcome outcome = tangents.advance(end);
    if (outcome == Outcome::search_failed) s.outcome = LyapunovOutcome::search_failed;
    if (outcome != Outcome::flying) ++s.events;
    if (s.events >= settings.most_events) s.outcome = LyapunovOutcome::budget_spent;
    growth.add(tip.now() - begin, settings.duration, tangents.growth());
  }
  s.duration = tangents.carried_to() - begin;
  s.rank = tangents.rank();
  if (!(s.duration > 0.0)) {
    if (s.outcome == LyapunovOutcome::measured) s.outcome = LyapunovOutcome::no_event;
    return s;
  }
  growth.finish(model, s);
  if (has_numbers(s)) {
    sort(s);
  } else if (s.outcome == LyapunovOutcome::measured) {
    s.outcome = LyapunovOutcome::no_number;
  }
  return s;
}

LyapunovSpectrum lyapunov(const Model& model, double eta, const FreeState& start, const LyapunovSettings& settings) {
  return lyapunov(model, eta, to_tip_state(model.H, start), settings);
}

LyapunovSpectrum lyapunov(const Model& model, double eta, const TipState& start, const LyapunovSettings& settings) {
  Tip tip(model, eta, start, settings.contact_tolerance);
  return lyapunov(model, tip, settings);
}

}  // namespace afm
