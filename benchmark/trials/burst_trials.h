// Bursts as tips make them, each set against its bounces one by one: how far off is the state at the next impact?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "afm/reflection.h"
#include "afm/tip.h"
#include "random_launches.h"

namespace afm {

struct BurstTrial {
  double bounces;              // one by one, up to the next impact
  double dt, phase, X, u, g1;  // errors there, absolute

  double worst() const { return std::max({dt, phase, X, u, g1}); }
};

// A bounce under pressure: most lead to chatter, which orbits of their own accord seldom do.
inline Tip pressed_tip(const Model& model, double eta, double tolerance, RandomLaunches& random) {
  for (;;) {
    TipState start{random.within(0.0, 1.0), random.within(-0.02, 0.02), eta * random.within(0.7, 1.3), 0.0,
                   random.power(-2.0, 0.0)};
    if (model.kind == ModelKind::hammer) start.X = 0.0, start.u = eta;
    const Flight<double> flight(SpringConstants<double>(model), eta, start);
    if (flight.start().g2 < 0.0) return {model, eta, start, tolerance};
  }
}

class BurstTrials {
 public:
  BurstTrials(const Model& model, double eta, double tolerance, unsigned seed, std::int64_t most_bounces)
      : model_(model),
        eta_(eta),
        tolerance_(tolerance),
        random_(seed),
        most_bounces_(most_bounces),
        tip_(pressed_tip(model, eta, tolerance, random_)) {}

  // The next burst; nothing where brute force does not reach its end, or where no launch leads to one.
  std::optional<BurstTrial> next() {
    const std::optional<TipState> bounce = next_burst();
    if (!bounce) return {};
    Tip burst = tip_, bounces(model_, eta_, *bounce, 0.0);
    double before = ModelTime{} - tip_.now();
    std::int64_t count = 0;
    if (!to_next_impact(burst, bounces, before, count)) return {};
    return compare(burst, before, bounces, count);
  }

  // Runs to where a burst has just begun; the state is that of its first bounce.
  std::optional<TipState> next_burst() {
    while (launches_ < kMostLaunches) {
      if (tip_.advance({kRun, 0.0}) == Outcome::time_limit) {
        tip_ = pressed_tip(model_, eta_, tolerance_, random_);
        ++launches_;
      }
      const Impact& impact = tip_.last_impact();
      const TipState slide = tip_.tip_state();
      if (impact.kind != ImpactKind::impact || slide.g != 0.0 || slide.g1 != 0.0) continue;
      const double after = restitution(model_, impact.normal_speed) * impact.normal_speed;
      if (!(after > 0.0)) continue;
      launches_ = 0;
      return detail::leave_surface(model_, {slide.phase, slide.X, slide.u}, after);
    }
    return {};
  }

  const Tip& tip() const { return tip_; }

 private:
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

  static constexpr int kRun = 5;              // [tau] between fresh starts
  static constexpr int kMostLaunches = 1000;  // without a burst: an elastic tip may make none
  static constexpr double kNear = 1e-3;       // [tau]

  Model model_;
  double eta_, tolerance_;
  RandomLaunches random_;
  std::int64_t most_bounces_;
  Tip tip_;
  int launches_ = 0;  // since the last burst
};

}  // namespace afm
