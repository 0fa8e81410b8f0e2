// Follows a tip from impact to impact and counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/run/interruptible_advance.h"

namespace afm {

// A point at which orbits are compared: the state after an impact or a release, its time, and the impacts so far.
struct Mark {
  TipState state;
  ModelTime time;
  int impacts;
};

inline double distance(const TipState& a, const TipState& b) {
  const double phase = a.phase - b.phase;
  return std::max(
      {std::abs(phase - std::round(phase)), std::abs(a.X - b.X), std::abs(a.u - b.u), std::abs(a.g1 - b.g1)});
}

// A bounce that hardly lifts the tip. At 0.01 a/tau and a reaction of 4 a/tau^2 it rises by 1.3e-5 a: v^2/2P.
inline bool is_creeping(const Impact& impact) {
  constexpr double kCreepSpeed = 1e-2;  // [a/tau]
  return impact.kind == ImpactKind::burst || impact.normal_speed < kCreepSpeed;
}

// Advances a tip from mark to mark within a budget of events, and sums the time in contact.
class Observer {
 public:
  Observer(Tip& tip, std::uint64_t most_events) : tip_(tip), left_(most_events) {}

  // False if the limit, the end of the budget or a failed search came first.
  bool next(const ModelTime& limit) {
    while (left_ > 0 && !failed_) {
      bool held = tip_.in_contact();
      const ModelTime before = tip_.now();
      const Outcome outcome = detail::advance_interruptibly(tip_, limit);
      --left_;
      held = held || (outcome == Outcome::impact && is_creeping(tip_.last_impact()));
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

}  // namespace afm
