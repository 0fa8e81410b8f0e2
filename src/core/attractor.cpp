#include "afm_emulator/attractor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "afm_emulator/tangents.h"

namespace afm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What an orbit is compared by: its state after an impact or a release, and the sums up to there.
struct Mark {
  TipState state;
  ModelTime time;
  int impacts;
};

double distance(const TipState& a, const TipState& b) {
  const double phase = a.phase - b.phase;
  return std::max({std::abs(phase - std::round(phase)), std::abs(a.X - b.X), std::abs(a.u - b.u), std::abs(a.g1 - b.g1)});
}

// Runs a tip from mark to mark, within a budget, and keeps the time spent in contact.
class Observer {
 public:
  Observer(Tip& tip, std::uint64_t most_events) : tip_(tip), left_(most_events) {}

  // False where the limit, the budget or a failed search came first.
  bool next(const ModelTime& limit) {
    while (left_ > 0 && !failed_) {
      const bool held = tip_.in_contact();
      const ModelTime before = tip_.now();
      const Outcome outcome = tip_.advance(limit);
      --left_;
      if (held) in_contact_ += tip_.now() - before;
      if (outcome == Outcome::time_limit) return false;
      failed_ = outcome == Outcome::search_failed;
      const bool single = outcome == Outcome::impact && tip_.last_impact().kind == ImpactKind::impact;
      impacts_ += single ? 1 : 0;
      if (single || outcome == Outcome::released) return true;
    }
    return false;
  }
  void run_until(const ModelTime& limit) {
    while (next(limit)) {
    }
  }

  Mark mark() const { return {tip_.tip_state(), tip_.now(), impacts_}; }
  bool stopped() const { return failed_ || left_ == 0; }
  std::uint64_t left() const { return left_; }
  double take_contact_time() { return std::exchange(in_contact_, 0.0); }

 private:
  Tip& tip_;
  std::uint64_t left_;
  bool failed_ = false;
  int impacts_ = 0;
  double in_contact_ = 0.0;
};

// The marks of one period, the first of them at both ends; empty where the orbit does not come back.
struct Period {
  int marks = 0, impacts = 0, cells = 0;
};

// Comes back to where it was, and once more.
Period find_period(Observer& observer, double eta, const ModelTime& limit, const AttractorSettings& settings) {
  if (!observer.next(limit)) return {};
  const Mark first = observer.mark();
  Period found;
  for (int n = 1; n <= 2 * settings.longest && observer.next(limit); ++n) {
    const Mark now = observer.mark();
    if (distance(now.state, first.state) > settings.tolerance) continue;
    if (found.marks == 0) {
      const double cells = std::abs(eta) * (now.time - first.time);
      found = {n, now.impacts - first.impacts, static_cast<int>(std::lround(cells))};
    } else if (n == 2 * found.marks) {
      return found;
    }
  }
  return {};
}

// The exponents of a periodic orbit are its multipliers': no limit has to be waited for.
LyapunovSpectrum exponents_of(const Model& model, Tip& tip, const Period& period) {
  LyapunovSpectrum s;
  Tangents tangents(model, tip);
  const double duration = period.cells / std::abs(tip.eta());
  if (!tangents.start(duration)) return s;
  const ModelTime begin = tip.now(), end = begin + 1.5 * duration;
  Eigen::Matrix4d J = Eigen::Matrix4d::Identity();
  double volume = 0.0;
  for (int marks = 0; marks < period.marks && tip.now() < end; ++s.events) {
    const Outcome outcome = tangents.advance(end);
    if (outcome == Outcome::search_failed || outcome == Outcome::time_limit) break;
    J = tangents.jacobian() * J;
    volume += tangents.stretch().volume;
    const bool single = outcome == Outcome::impact && tip.last_impact().kind == ImpactKind::impact;
    if (single || outcome == Outcome::released) ++marks;
  }
  s.outcome = LyapunovOutcome::measured;
  s.rank = tangents.rank();
  s.duration = duration;
  s.volume_rate = s.rank < 4 ? -kInfinity : volume / duration;
  Eigen::Vector4d sizes = J.eigenvalues().cwiseAbs();
  std::sort(sizes.data(), sizes.data() + 4, std::greater<double>());
  for (int i = 0; i < 4; ++i) {
    s.exponents[static_cast<std::size_t>(i)] = i < s.rank ? std::log(sizes[i]) / duration : -kInfinity;
  }
  return s;
}

// An exponent within this of 0 is that of a torus or of a bifurcation [1/tau]; and within so many standard errors.
constexpr double kNoGrowth = 0.01, kStandardErrors = 4.0;

AttractorKind kind_of(const LyapunovSpectrum& s) {
  if (s.outcome != LyapunovOutcome::measured) return AttractorKind::undecided;
  if (s.exponents[0] > std::max(kNoGrowth, kStandardErrors * s.std_errors[0])) return AttractorKind::chaotic;
  return s.exponents[0] > -kNoGrowth ? AttractorKind::quasi_periodic : AttractorKind::undecided;
}

bool at_rest(const Tip& tip) {
  constexpr double kStill = 1e-9;  // [a/tau]
  return tip.eta() == 0.0 && std::abs(tip.tip_state().u) < kStill && tip.tip_state().g < kStill;
}

}  // namespace

std::string Attractor::name() const {
  switch (kind) {
    case AttractorKind::periodic:
      return "period-" + std::to_string(impacts);
    case AttractorKind::quasi_periodic:
      return "quasi-periodic";
    case AttractorKind::chaotic:
      return "chaotic";
    case AttractorKind::contact:
      return "contact";
    case AttractorKind::rest:
      return "rest";
    default:
      return "undecided";
  }
}

Attractor find_attractor(const Model& model, Tip& tip, const AttractorSettings& settings) {
  Attractor found;
  Observer observer(tip, settings.most_events);
  observer.run_until(tip.now() + settings.transient);
  observer.take_contact_time();
  const ModelTime begin = tip.now(), end = begin + settings.duration;
  const int impacts_before = observer.mark().impacts;
  Period period;
  while (tip.now() < end && !observer.stopped() && period.marks == 0) {
    period = find_period(observer, tip.eta(), end, settings);
  }
  const double seen = tip.now() - begin;
  if (observer.stopped() || !(seen > 0.0)) return found;
  found.contact_share = observer.take_contact_time() / seen;
  found.rotation_number = std::abs(tip.eta()) * seen / std::max(1, observer.mark().impacts - impacts_before);
  if (period.marks > 0) {
    found.kind = AttractorKind::periodic;
    found.impacts = period.impacts;
    found.cells = period.cells;
    found.rotation_number = static_cast<double>(period.cells) / std::max(1, period.impacts);
    found.lyapunov = exponents_of(model, tip, period);
  } else {
    found.lyapunov = lyapunov(model, tip, {0.0, settings.duration, observer.left(), 0.0});
    found.kind = kind_of(found.lyapunov);
  }
  if (found.contact_share > 0.5) found.kind = at_rest(tip) ? AttractorKind::rest : AttractorKind::contact;
  return found;
}

Attractor find_attractor(const Model& model, double eta, const TipState& start, const AttractorSettings& settings) {
  Tip tip(model, eta, start);
  return find_attractor(model, tip, settings);
}

}  // namespace afm
