#include "afm_emulator/time_average.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "afm_emulator/batch_means.h"

namespace afm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBatches = 64;  // few enough to be long, enough to tell their spread

constexpr double kRounding = 2e-15;  // of the friction on a periodic orbit, relative: a few units in the last place

// A sum whose rounding is carried along (Neumaier).
class Sum {
 public:
  void add(double x) {
    const double sum = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0.0, rest_ = 0.0;
};

// What happens from one time to another.
struct Books {
  Sum energy;
  double impacts = 0.0, time = 0.0, contact_time = 0.0;
  std::uint64_t search_failures = 0;
};

// Writes the books up to `end`, and tells each event's time since now and energy to `on_loss`.
template <class OnLoss>
Books keep_books(Tip& tip, const ModelTime& end, OnLoss on_loss) {
  Books books;
  const ModelTime begin = tip.now();
  ModelTime touched = begin;
  bool in_contact = tip.in_contact();
  for (Outcome outcome; (outcome = tip.advance(end)) != Outcome::time_limit;) {
    if (outcome == Outcome::search_failed) {
      ++books.search_failures;
      continue;
    }
    const Impact& impact = tip.last_impact();
    books.energy.add(impact.energy_loss);
    books.impacts += impact.count;
    on_loss(impact.time - begin, impact.energy_loss);
    if (outcome == Outcome::contact) touched = tip.now();
    if (outcome == Outcome::released) books.contact_time += tip.now() - touched;
    in_contact = tip.in_contact();
  }
  if (in_contact) books.contact_time += tip.now() - touched;
  books.time = tip.now() - begin;
  return books;
}

FrictionAverage average_of(const Books& books, double eta) {
  const double energy = books.energy.value();
  const double per_impact = books.impacts > 0.0 ? 1.0 / books.impacts : kNaN;
  FrictionAverage a;
  a.K_f = eta == 0.0 ? kNaN : energy / (eta * eta * books.time);
  a.impacts_per_tau = books.impacts / books.time;
  a.mean_energy_loss = energy * per_impact;
  a.mean_flight_time = (books.time - books.contact_time) * per_impact;
  a.search_failures = books.search_failures;
  return a;
}

// The middle of the longest time without an event in the next `span`: a window of whole periods that begins there holds
// each event of the orbit as often, however the times of events are rounded.
ModelTime quiet_time(Tip tip, double span) {
  constexpr int kMostEvents = 10000;
  const ModelTime end = tip.now() + span;
  ModelTime last = tip.now(), quiet = last;
  double longest = 0.0;
  for (int i = 0; i < kMostEvents && tip.now() < end; ++i) {
    tip.advance(end);
    const double pause = tip.now() - last;
    if (pause > longest) {
      longest = pause;
      quiet = last + 0.5 * pause;
    }
    last = tip.now();
  }
  return quiet;
}

}  // namespace

FrictionAverage average_over_time(Tip& tip, double duration) {
  std::vector<double> batches(kBatches);
  const double length = duration / static_cast<double>(kBatches), eta = tip.eta();
  const Books books = keep_books(tip, tip.now() + duration, [&](double age, double energy) {
    batches[std::min(kBatches - 1, static_cast<std::size_t>(age / length))] += energy;
  });
  FrictionAverage average = average_of(books, eta);
  average.K_f_std_error = eta == 0.0 ? kNaN : mean_error(std::move(batches)).std_error / (length * eta * eta);
  return average;
}

FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration) {
  const double eta = tip.eta(), period = static_cast<double>(cells) / std::abs(eta);
  const double periods = std::max(1.0, std::floor(0.5 * duration / period));
  const auto ignore = [](double, double) {};
  keep_books(tip, quiet_time(tip, period), ignore);
  const ModelTime middle = tip.now() + periods * period;
  const FrictionAverage first = average_of(keep_books(tip, middle, ignore), eta);
  FrictionAverage second = average_of(keep_books(tip, middle + periods * period, ignore), eta);
  second.K_f_std_error = std::abs(second.K_f - first.K_f) + kRounding * second.K_f;
  second.search_failures += first.search_failures;
  return second;
}

}  // namespace afm
