// Bursts as tips make them, each set against its bounces one by one: how far off is the state at the next impact?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "afm/reflection.h"
#include "afm/tip.h"
#include "random_launches.h"

namespace afm {

struct BurstTrial {
  double bounces;              // one by one, up to the next impact
  double dt, phase, X, u, g1;  // errors there, absolute

  double worst() const { return std::max({dt, phase, X, u, g1}); }
};

class BurstTrials {
 public:
  BurstTrials(const Model& model, double eta, double tolerance, unsigned seed, std::int64_t most_bounces)
      : model_(model),
        eta_(eta),
        tolerance_(tolerance),
        random_(seed),
        most_bounces_(most_bounces),
        tip_(fresh()) {}

  // The next burst of which brute force reaches the end.
  BurstTrial next() {
    for (;;) {
      const TipState bounce = next_burst();
      Tip burst = tip_, bounces(model_, eta_, bounce, 0.0);
      double before = ModelTime{} - tip_.now();
      std::int64_t count = 0;
      if (to_next_impact(burst, bounces, before, count)) return compare(burst, before, bounces, count);
      ++skipped_;
    }
  }
  long skipped() const { return skipped_; }

 private:
  // A bounce under pressure: most lead to chatter, which orbits of their own accord seldom do.
  Tip fresh() {
    for (;;) {
      const TipState start{random_.within(0.0, 1.0), random_.within(-0.02, 0.02), eta_ * random_.within(0.7, 1.3), 0.0,
                           std::pow(10.0, random_.within(-2.0, 0.0))};
      const Flight<double> flight(SpringConstants<double>(model_), eta_, start);
      end_ = {kRun, 0.0};
      if (flight.start().g2 < 0.0) return {model_, eta_, start, tolerance_};
    }
  }

  // Runs to where a burst has just begun; the state is that of its first bounce.
  TipState next_burst() {
    for (;;) {
      if (tip_.advance(end_) == Outcome::time_limit) tip_ = fresh();
      const Impact& impact = tip_.last_impact();
      const TipState slide = tip_.tip_state();
      if (impact.kind != ImpactKind::impact || slide.g != 0.0 || slide.g1 != 0.0) continue;
      const double after = restitution(model_, impact.normal_speed) * impact.normal_speed;
      if (!(after > 0.0)) continue;
      return detail::leave_surface(model_, {slide.phase, slide.X, slide.u}, after);
    }
  }

  // Where the burst lets go, its next bounce; where it has died into contact, the first impact after the release.
  bool to_next_impact(Tip& burst, Tip& bounces, double& before, std::int64_t& count) const {
    const ModelTime begin = burst.now();
    if (burst.advance(begin + 1000.0) != Outcome::impact) return false;
    const bool burst_ended = burst.last_impact().kind == ImpactKind::burst;
    if (burst_ended && burst.tip_state().g1 > 0.0) {
      const std::int64_t all = std::int64_t{burst.last_impact().count} + 1;
      const double ended = burst.now() - begin;
      burst =
          Tip(model_, eta_, burst.tip_state(), 0.0);  // its next bounce by itself, even if that begins another burst
      before = ended;
      std::int64_t one = 0;
      return all < most_bounces_ && bounce(burst, 1, one) && bounce(bounces, all, count);
    }
    ModelTime released = burst.now();
    for (Outcome outcome; (outcome = burst.advance(begin + 1000.0)) != Outcome::impact;) {
      if (outcome == Outcome::time_limit) return false;
      released = burst.now();
    }
    // by then the bounces are far slower
    const double slowest = 0.5 * burst.last_impact().normal_speed;
    return to_impact(bounces, ModelTime{} + ((released - begin) - kNear), slowest, count);
  }

  bool bounce(Tip& tip, std::int64_t times, std::int64_t& count) const {
    for (; count < times; ++count) {
      if (tip.advance(tip.now() + 1000.0) != Outcome::impact) return false;
    }
    return true;
  }

  bool to_impact(Tip& tip, const ModelTime& earliest, double slowest, std::int64_t& count) const {
    while (count < most_bounces_) {
      const Outcome outcome = tip.advance(tip.now() + 1000.0);
      if (outcome == Outcome::time_limit) return false;
      ++count;
      if (outcome == Outcome::impact && tip.last_impact().normal_speed > slowest && earliest < tip.now()) return true;
    }
    return false;
  }

  // before: from the start of the burst to time 0 of the tip that ended it
  BurstTrial compare(const Tip& burst, double before, const Tip& bounces, std::int64_t count) const {
    const TipState a = burst.tip_state(), b = bounces.tip_state();
    const double cells = a.phase - b.phase;
    return {static_cast<double>(count),
            std::abs(before + (burst.now() - bounces.now())),
            std::abs(cells - std::round(cells)),
            std::abs(a.X - b.X),
            std::abs(a.u - b.u),
            std::abs(a.g1 - b.g1)};
  }

  static constexpr int kRun = 5;         // [tau] between fresh starts
  static constexpr double kNear = 1e-3;  // [tau]

  Model model_;
  double eta_, tolerance_;
  RandomLaunches random_;
  std::int64_t most_bounces_;
  ModelTime end_;
  Tip tip_;
  long skipped_ = 0;
};

}  // namespace afm
