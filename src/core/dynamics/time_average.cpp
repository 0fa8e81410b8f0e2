#include "afm/dynamics/time_average.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "afm/detail/batch_means.h"

namespace afm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBatches = 64;  // few enough to be long, enough to tell their spread

constexpr double kRounding = 2e-15;  // of the friction on a periodic orbit, relative: a few units in the last place

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

void bring_to(Tip& tip, const ModelTime& end) {
  while (tip.advance(end) != Outcome::time_limit) continue;
}

// Takes the events of a tip that is brought to limit() time after time until the meter is done.
class FrictionMeter {
 public:
  // Of an orbit that repeats itself after `cells` cells, or wanders: 0. The tip is moved to where the meter begins.
  FrictionMeter(Tip& tip, std::int64_t cells, double duration);

  bool done() const { return windows_left_ == 0; }
  const ModelTime& limit() const { return end_; }
  void add(const Impact& event);
  void add_search_failures(std::uint64_t n) { totals_.search_failures += n; }
  void reach_limit();                                          // the tip is there
  const FrictionAverage& average() const { return average_; }  // once done

 private:
  // A sum whose rounding is carried along (Neumaier).
  class Sum {
   public:
    void add(double x);
    double value() const { return sum_ + rest_; }

   private:
    double sum_ = 0.0, rest_ = 0.0;
  };
  struct Totals {
    Sum energy;
    double impacts = 0.0, contact_time = 0.0;
    std::uint64_t search_failures = 0;
  };

  void begin_window(const ModelTime& begin);
  FrictionAverage window_average() const;

  double eta_, length_;  // of a window [tau]
  int windows_left_;
  ModelTime begin_, end_, touched_;
  bool in_contact_;
  Totals totals_;
  std::vector<double> batches_;  // of an orbit that wanders: energies lost
  FrictionAverage average_;
};

void FrictionMeter::Sum::add(double x) {
  const double sum = sum_ + x;
  rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
  sum_ = sum;
}

FrictionMeter::FrictionMeter(Tip& tip, std::int64_t cells, double duration)
    : eta_(tip.eta()), length_(duration), windows_left_(1), batches_(cells > 0 ? 0 : kBatches) {
  if (cells > 0) {
    const double period = static_cast<double>(cells) / std::abs(eta_);
    length_ = std::max(1.0, std::floor(0.5 * duration / period)) * period;
    windows_left_ = 2;
    bring_to(tip, quiet_time(tip, period));
  }
  in_contact_ = tip.in_contact();
  begin_window(tip.now());
}

void FrictionMeter::begin_window(const ModelTime& begin) {
  totals_ = {};
  begin_ = touched_ = begin;
  end_ = begin + length_;
}

void FrictionMeter::add(const Impact& event) {
  totals_.energy.add(event.energy_loss);
  totals_.impacts += event.count;
  if (!batches_.empty()) {
    const double age = event.time - begin_, length = length_ / static_cast<double>(kBatches);
    batches_[std::min(kBatches - 1, static_cast<std::size_t>(age / length))] += event.energy_loss;
  }
  if (event.kind == ImpactKind::contact_begun) touched_ = event.time;
  if (event.kind == ImpactKind::contact_ended) totals_.contact_time += event.time - touched_;
  in_contact_ = event.kind == ImpactKind::contact_begun;
}

FrictionAverage FrictionMeter::window_average() const {
  const double energy = totals_.energy.value(), time = end_ - begin_;
  const double contact_time = totals_.contact_time + (in_contact_ ? end_ - touched_ : 0.0);
  const double per_impact = totals_.impacts > 0.0 ? 1.0 / totals_.impacts : kNaN;
  FrictionAverage a;
  a.K_f = eta_ == 0.0 ? kNaN : energy / (eta_ * eta_ * time);
  a.impacts_per_tau = totals_.impacts / time;
  a.mean_energy_loss = energy * per_impact;
  a.mean_flight_time = (time - contact_time) * per_impact;
  a.search_failures = totals_.search_failures;
  return a;
}

void FrictionMeter::reach_limit() {
  const FrictionAverage before = average_;
  average_ = window_average();
  --windows_left_;
  if (!batches_.empty()) {
    const double length = length_ / static_cast<double>(kBatches);
    average_.K_f_std_error = eta_ == 0.0 ? kNaN : mean_error(std::move(batches_)).std_error / (length * eta_ * eta_);
  } else if (windows_left_ == 1) {
    begin_window(end_);
  } else {
    average_.K_f_std_error = std::abs(average_.K_f - before.K_f) + kRounding * average_.K_f;
    average_.search_failures += before.search_failures;
  }
}

FrictionAverage measure(Tip& tip, FrictionMeter& meter) {
  while (!meter.done()) {
    for (Outcome outcome; (outcome = tip.advance(meter.limit())) != Outcome::time_limit;) {
      outcome == Outcome::search_failed ? meter.add_search_failures(1) : meter.add(tip.last_impact());
    }
    meter.reach_limit();
  }
  return meter.average();
}

}  // namespace

FrictionAverage average_over_time(Tip& tip, double duration) { return average_over_periods(tip, 0, duration); }

FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration) {
  FrictionMeter meter(tip, cells, duration);
  return measure(tip, meter);
}

}  // namespace afm
