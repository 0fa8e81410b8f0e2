// The energy balance of a tip, from the records of its segments (afm/segment.h): the drag works only through the
// holder, so what is lost is what it put in, less what is stored.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/tip.h"

namespace afm {

// In the springs and in motion over the ground [m_tip a^2/tau^2].
inline double stored_energy(const Model& m, const FreeState& s) {
  const double omega_h = kTwoPi * m.frequency_ratio, Y = s.y - m.y0;
  return 0.5 * (s.u * s.u + s.w * s.w + omega_h * omega_h * s.X * s.X + kTwoPi * kTwoPi * Y * Y);
}

class EnergyBalance {
 public:
  explicit EnergyBalance(const Tip& tip) : stored_(tip.stored_energy()) {}

  // Tip::advance_segment, its segments added.
  Outcome advance_segment(Tip& tip, const ModelTime& limit) {
    Segments ended;
    const Outcome outcome = tip.advance_segment(limit, &ended);
    for (const Segment& segment : ended) add(segment, tip);
    return outcome;
  }

  // Such as tip.drag(eta): it ends a segment unless it changes nothing, and may change the energy by itself.
  template <class Command>
  void command(const Tip& tip, const Command& act) {
    const Segment before = tip.segment();
    act();
    if (!(tip.segment().begin == tip.now())) return;
    add(before, tip);
    stored_ = tip.stored_energy();
  }

  // Energy from nothing: in the sum of all segments, or between it and the state of the tip. A hammer's holder changes
  // the state where it takes up a new velocity.
  double imbalance(const Tip& tip) const {
    const double sum = std::abs(static_cast<double>(imbalance_));
    if (tip.model().kind == ModelKind::hammer) return sum;
    const double now = tip.stored_energy(), by_records = stored_ + tip.segment().stored;
    // in a chatter sequence the state is that of the reference slide, without the bounces
    const double of_state = tip.in_chatter() ? now : afm::stored_energy(tip.model(), tip.state());
    return std::max({sum, std::abs(by_records - now), std::abs(of_state - now)});
  }
  // What it is to be compared with: all that has been turned over.
  double turnover(const Tip& tip) const {
    return static_cast<double>(gross_) + tip.stored_energy() + std::abs(stored_);
  }
  double lost() const { return static_cast<double>(lost_); }
  // The largest imbalance of a segment, as a part of what the segment turned over. The stored energy is rounded: that
  // much is no imbalance.
  double worst_segment() const { return worst_segment_; }

 private:
  void add(const Segment& segment, const Tip& tip) {
    constexpr double kRounding = 1e-13;  // of the stored energy, as the steps in contact allow themselves
    // [m_tip a^2/tau^2] places are rounded as parts of a cell, however slow the tip
    constexpr double kOfPlaces = 1e-15;
    const double moved = std::abs(segment.loss) + std::abs(segment.heat) + std::abs(segment.work());
    const double stored = std::max(std::abs(stored_), std::abs(stored_ + segment.stored));
    double rounding = kOfPlaces + (kRounding + slope_rounding(tip.model(), stored)) * stored;
    if (segment.kind == SegmentKind::contact) rounding += rest_error(tip, segment.eta);
    const double excess = std::abs(segment.imbalance()) - rounding;
    const double turned = moved + std::abs(segment.stored) + 0.5 * segment.eta * segment.eta;
    if (excess > 0.0) worst_segment_ = std::max(worst_segment_, excess / turned);
    lost_ += segment.loss;
    gross_ += moved;
    imbalance_ += segment.imbalance();
    stored_ += segment.stored;
  }

  // Where the extension is many cells, the place is rounded as it is, at the start of a flight and at its end, and the
  // slope there turns the velocity by so much.
  static double slope_rounding(const Model& m, double stored) {
    if (m.kind == ModelKind::hammer) return 0.0;
    const double most_extension = std::sqrt(2.0 * stored) / (kTwoPi * m.frequency_ratio);
    return kTwoPi * kTwoPi * m.H * most_extension * 0x1p-52;
  }

  // A tip that slides more slowly than a swing of ten tolerances of a step is at rest as far as the step can tell.
  // Where the drag is as slow, nothing takes an error of its energy (docs/algorithm.md, "Contact").
  static double rest_error(const Tip& tip, double eta) {
    constexpr double kTenSteps = 2e-3;  // the tolerance of a step is a 5000th of the contact tolerance
    const double swing = kTwoPi * tip.model().frequency_ratio * kTenSteps * tip.contact_tolerance();
    return std::max(std::abs(tip.tip_state().u), std::abs(eta)) < swing ? swing * swing : 0.0;
  }

  double stored_;  // by the records
  double worst_segment_ = 0.0;
  long double lost_ = 0.0L, gross_ = 0.0L, imbalance_ = 0.0L;
};

}  // namespace afm
