#include "afm/time_average.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "afm/friction.h"
#include "afm/interruption.h"
#include "core/not_numbers.h"
#include "core/run/batch_means.h"
#include "core/run/interruptible_advance.h"

namespace afm {

using namespace detail;

namespace {

// Relative rounding of the friction on a periodic orbit: nine units in the last place.
constexpr double kRounding = 2e-15;

// The middle of the longest time without an event in the next `span`. A window of whole periods that begins there
// counts each event of the orbit equally often, despite rounding of the times.
ModelTime quiet_time(Tip tip, double span) {
  constexpr int kMaxEvents = 10000;  // a guard: periodic orbits have up to 128 impacts
  const ModelTime end = tip.now() + span;
  ModelTime last = tip.now(), quiet = last;
  double longest = 0.0;
  for (int i = 0; i < kMaxEvents && tip.now() < end; ++i) {
    advance_interruptibly(tip, end);
    const double pause = tip.now() - last;
    if (pause > longest) {
      longest = pause;
      quiet = last + 0.5 * pause;
    }
    last = tip.now();
  }
  return quiet;
}

// Sums over an interval of time.
struct Totals {
  CompensatedSum energy, impulse, heat;  // energy lost in impacts; impulse of the holder; energy given to the bath
  double impacts = 0.0, contact_time = 0.0;
  bool has_bath = false;
  std::uint64_t search_failures = 0;

  void spoil() {
    energy.add(kNaN);
    impulse.add(kNaN);
    impacts = kNaN;
  }
};

// Brings the tip to `end`. Where a search cannot go on no sum is a number any more.
void follow(Tip& tip, const ModelTime& end, Totals& totals) {
  ModelTime touched = tip.now();
  totals.impulse.add(-tip.segment().impulse);  // the part before the interval
  Segments ended;
  for (;;) {
    const ModelTime begin = tip.now();
    const Outcome outcome = tip.advance_segment(end, &ended);
    if (outcome == Outcome::time_limit) break;
    interruption_point();
    for (const Segment& segment : ended) {
      totals.impulse.add(segment.impulse);
      if (segment.kind != SegmentKind::kick) continue;
      totals.has_bath = true;
      totals.heat.add(segment.heat);
    }
    if (outcome == Outcome::search_failed) {
      ++totals.search_failures;
      if (!(begin < tip.now())) return totals.spoil();
    }
    if (outcome == Outcome::flying || outcome == Outcome::search_failed) continue;
    const Impact& event = tip.last_impact();
    totals.energy.add(event.energy_loss);
    totals.impacts += event.count;
    if (event.kind == ImpactKind::contact_begun) touched = event.time;
    if (event.kind == ImpactKind::contact_ended) totals.contact_time += event.time - touched;
  }
  if (tip.in_contact()) totals.contact_time += end - touched;
  totals.impulse.add(tip.segment().impulse);
}

FrictionAverage average_of(const Totals& totals, double eta, double time) {
  const double per_impact = totals.impacts > 0.0 ? 1.0 / totals.impacts : kNaN;
  const double energy = totals.energy.value;
  FrictionAverage a;
  a.K_f = eta == 0.0 ? kNaN : energy / (eta * eta * time);
  a.K_f_work = eta == 0.0 ? kNaN : totals.impulse.value / (eta * time);
  a.impacts_per_tau = totals.impacts / time;
  a.mean_energy_loss = energy * per_impact;
  a.mean_flight_time = (time - totals.contact_time) * per_impact;
  a.search_failures = totals.search_failures;
  return a;
}

}  // namespace

FrictionAverage average_over_time(Tip& tip, double duration) {
  const ModelTime begin = tip.now();
  const double eta = tip.eta(), length = duration / static_cast<double>(kTimeBatches);
  std::vector<double> energies(kTimeBatches), impulses(kTimeBatches);
  Totals totals;
  for (std::size_t i = 0; i < kTimeBatches; ++i) {
    const double energy = totals.energy.value, impulse = totals.impulse.value;
    follow(tip, begin + length * static_cast<double>(i + 1), totals);
    energies[i] = totals.energy.value - energy;
    impulses[i] = totals.impulse.value - impulse;
  }
  FrictionAverage a = average_of(totals, eta, tip.now() - begin);
  if (eta == 0.0) {
    a.K_f_std_error = a.K_f_work_std_error = kNaN;
    return a;
  }
  a.K_f_std_error = mean_error(std::move(energies)).std_error / (length * eta * eta);
  const double stored = a.K_f_work - a.K_f - totals.heat.value / (eta * eta * (tip.now() - begin));
  const double scatter =
      totals.has_bath ? mean_error(std::move(impulses)).std_error / (length * std::abs(eta)) : a.K_f_std_error;
  a.K_f_work_std_error = work_std_error(scatter, stored);
  return a;
}

FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration) {
  if (cells == 0) return average_over_time(tip, duration);
  const double eta = tip.eta(), period = static_cast<double>(cells) / std::abs(eta);
  const double length = std::max(1.0, std::floor(0.5 * duration / period)) * period;
  bring_to(tip, quiet_time(tip, period));
  Totals totals[2];
  FrictionAverage halves[2];
  for (int i = 0; i < 2; ++i) {
    const ModelTime begin = tip.now(), end = begin + length;
    follow(tip, end, totals[i]);
    halves[i] = average_of(totals[i], eta, end - begin);
  }
  FrictionAverage a = halves[1];
  a.K_f_std_error = std::abs(a.K_f - halves[0].K_f) + kRounding * a.K_f;
  a.K_f_work_std_error = std::abs(a.K_f_work - halves[0].K_f_work) + kRounding * std::abs(a.K_f_work);
  a.search_failures += halves[0].search_failures;
  return a;
}

}  // namespace afm
