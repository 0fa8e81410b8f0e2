// Bursts as tips make them, each set against its bounces one by one: how far off is the state at the next real impact?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "afm_emulator/reflection.h"
#include "afm_emulator/tip.h"
#include "random_launches.h"

namespace afm {

// Impacts slower than this are part of chatter: about three times the fastest bounce that a burst holds [a/tau].
inline double slowest_real_impact(double tolerance) { return 3.0 * std::sqrt(tolerance); }

struct BurstTrial {
  double bounces;              // one by one, up to the next real impact
  double normal_speed;         // of that
  double dt, phase, X, u, g1;  // errors there, absolute

  double state() const { return std::max({phase, X, u, g1}); }
  // A graze is a state hard to reach in time whatever led to it: times the normal speed its error is one of position.
  double worst() const { return std::max(dt, state()); }
  double tempered() const { return std::min(1.0, normal_speed) * worst(); }
};

class BurstTrials {
 public:
  BurstTrials(const Model& model, double eta, double tolerance, unsigned seed, std::int64_t most_bounces)
      : model_(model), eta_(eta), tolerance_(tolerance), random_(seed), most_bounces_(most_bounces), tip_(fresh()) {}

  // The next burst of which brute force reaches the end.
  BurstTrial next() {
    for (;;) {
      const TipState bounce = next_burst();
      Tip burst = tip_, bounces(model_, eta_, bounce, 0.0);
      const ModelTime begin = tip_.now();
      std::int64_t count = 0, few = 0;
      if (!to_real_impact(burst, few) || !to_real_impact(bounces, count)) {
        ++skipped_;
        continue;
      }
      return compare(burst, begin, bounces, count);
    }
  }
  long skipped() const { return skipped_; }

 private:
  // A bounce under pressure: most lead to chatter, which orbits of their own accord seldom do.
  Tip fresh() {
    for (;;) {
      const TipState start{random_.within(0.0, 1.0), random_.within(-0.02, 0.02), eta_ * random_.within(0.7, 1.3), 0.0,
                           std::pow(10.0, random_.within(-2.0, 0.0))};
      const Flight<double> flight(Mechanics<double>(model_), eta_, start);
      end_ = {kRun, 0.0};
      if (flight.start().g2 < 0.0) return {model_, eta_, start, tolerance_};
    }
  }

  // Runs to where a burst has just begun; the state is that of its first bounce.
  TipState next_burst() {
    for (;;) {
      if (tip_.advance(end_) == Outcome::time_limit) tip_ = fresh();
      const Impact& impact = tip_.last_impact();
      const TipState guide = tip_.tip_state();
      if (impact.kind != ImpactKind::impact || guide.g != 0.0 || guide.g1 != 0.0) continue;
      const double after = restitution(model_, impact.normal_speed) * impact.normal_speed;
      if (!(after > 0.0)) continue;
      const double slope = surface_jet(model_.H, guide.phase).h1;
      return unsettle(model_, {guide.phase, guide.X, guide.u}, after * std::sqrt(1.0 + slope * slope));
    }
  }

  bool to_real_impact(Tip& tip, std::int64_t& count) const {
    while (count < most_bounces_) {
      const Outcome outcome = tip.advance(tip.now() + 1000.0);
      if (outcome == Outcome::time_limit) return false;
      ++count;
      if (outcome == Outcome::impact && tip.last_impact().kind == ImpactKind::impact &&
          tip.last_impact().normal_speed > slowest_real_impact(tolerance_)) {
        return true;
      }
    }
    return false;
  }

  BurstTrial compare(const Tip& burst, const ModelTime& begin, const Tip& bounces, std::int64_t count) const {
    const TipState a = burst.tip_state(), b = bounces.tip_state();
    const double cells = a.phase - b.phase;
    return {static_cast<double>(count),
            bounces.last_impact().normal_speed,
            std::abs((burst.now() - begin) - (bounces.now() - ModelTime{})),
            std::abs(cells - std::round(cells)),
            std::abs(a.X - b.X),
            std::abs(a.u - b.u),
            std::abs(a.g1 - b.g1)};
  }

  static constexpr int kRun = 5;  // [tau] between fresh starts

  Model model_;
  double eta_, tolerance_;
  RandomLaunches random_;
  std::int64_t most_bounces_;
  ModelTime end_;
  Tip tip_;
  long skipped_ = 0;
};

}  // namespace afm
