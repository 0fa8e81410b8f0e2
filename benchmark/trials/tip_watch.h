// A tip under watch: after every segment it must be finite, nowhere below the surface, its energy in balance, and
// further in time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "afm/tip.h"
#include "energy_balance.h"

namespace afm {

struct TipCount {
  std::uint64_t segments = 0, impacts = 0, bounces = 0, commands = 0;
  std::uint64_t events = 0;  // what a batch tells and its budget counts
  std::uint64_t most_segments_in_a_tau = 0;
  double deepest = 0.0;          // below the surface [a], or part of what places are rounded with if more than 1 a
  double worst_imbalance = 0.0;  // of the energy turned over
};

class TipWatch {
 public:
  TipWatch(const Model& model, double eta, const FreeState& start, double contact_tolerance)
      : tip_(model, eta, start, contact_tolerance), balance_(tip_) {}

  // One segment, or to the limit. False: what violation() tells has happened.
  bool advance_segment(const ModelTime& limit, Outcome& outcome) {
    const ModelTime begin = tip_.now(), segment_end = tip_.segment_end(),
                    end = segment_end < limit ? segment_end : limit;
    if (segment_end < begin) return violated("a segment ends before it begins");
    if (!check_depths(begin, end)) return false;
    outcome = balance_.advance_segment(tip_, limit);
    enter(outcome);
    if (outcome == Outcome::search_failed) return violated("the search failed");
    if (tip_.now() < begin) return violated("time ran backwards");
    const TipState s = tip_.tip_state();
    if (!std::isfinite(s.phase + s.X + s.u + s.g + s.g1)) return violated("not finite");
    return check_energy() && check_rate();
  }

  bool advance(const ModelTime& limit) {
    Outcome outcome = Outcome::flying;
    while (outcome != Outcome::time_limit) {
      if (!advance_segment(limit, outcome)) return false;
    }
    return true;
  }

  void drag(double eta) {
    balance_.command(tip_, [&] { tip_.drag(eta); });
    ++count_.commands;
  }

  void set_parameters(const Model& model) {
    balance_.command(tip_, [&] { tip_.set_parameters(model); });
    ++count_.commands;
  }

  void set_bath(const Bath& bath) {
    balance_.command(tip_, [&] { tip_.set_bath(bath); });
    ++count_.commands;
  }

  const Tip& tip() const { return tip_; }
  const TipCount& count() const { return count_; }

  std::string violation() const {
    const TipState s = tip_.tip_state();
    const Model& model = tip_.model();
    const Bath& bath = tip_.thermostat().bath();
    std::ostringstream text;
    text.precision(17);
    text << violation_ << "\n  at " << tip_.now().tau << " + " << tip_.now().phase << "\n  gamma " << model.gamma
         << " v_c " << model.v_c << " H " << model.H << " y0 " << model.y0 << " ratio " << model.frequency_ratio
         << " kT " << bath.temperature << " Q " << bath.quality_factor << " kicks " << bath.kicks_per_tau << " eta "
         << tip_.eta() << "\n  phase " << s.phase << " X " << s.X << " u " << s.u << " g " << s.g << " g1 " << s.g1
         << (tip_.in_contact()   ? " in contact"
             : tip_.in_chatter() ? " in a burst"
                                 : "");
    return text.str();
  }

 private:
  static constexpr double kMostImbalance = 1e-9;
  static constexpr double kLeastTurnover =
      1e-9;  // [m_tip a^2/tau^2] to judge by: places are rounded as parts of a cell, however slow
  static constexpr double kMostDepth = 1e-15;  // [a], times what places are rounded with if that is more than 1 a
  static constexpr std::uint64_t kMostSegmentsInATau = 1000000;  // far more than any tau needs: a stall

  bool violated(const std::string& what) {
    violation_ = what;
    return false;
  }

  bool check_depth(const ModelTime& t) {
    const Deflection d = tip_.deflection(t);
    if (!std::isfinite(d.vertical) || !std::isfinite(d.lateral) || !std::isfinite(d.gap)) return violated("not finite");
    if (!(d.gap < 0.0)) return true;
    // the height, and what the surface rises by over the rounding of the place: of a phase below 1, of the amplitude of
    // the lateral swing, by which a flight bounds its rounding (Lemma 7 of docs/algorithm.md)
    const TipState now = tip_.tip_state();
    const double omega_h = kTwoPi * tip_.model().frequency_ratio;
    const double swing =
        tip_.model().kind == ModelKind::hammer ? 0.0 : std::hypot(now.X, (now.u - tip_.eta()) / omega_h);
    const double place = std::max({0.25, std::abs(d.lateral), swing});
    // and what the tip falls by over the rounding of the time, from 9 a/tau on
    Tip then = tip_;
    then.advance_segment(t);
    const double rate = then.in_flight() ? std::abs(then.tip_state().g1) : 0.0;
    const double fall = rate * 0x1p-53 / kMostDepth;
    const double rounded = std::max({1.0, std::abs(d.vertical), kTwoPi * tip_.model().H * place, fall});
    count_.deepest = std::max(count_.deepest, -d.gap / rounded);
    return -d.gap <= kMostDepth * rounded || violated("the gap is " + std::to_string(d.gap * 1e15) + "e-15");
  }

  bool check_depths(const ModelTime& begin, const ModelTime& end) {
    constexpr int kSamples = 6;
    constexpr double kGoldenSection = 0.6180339887498949;  // its multiples fall evenly and never twice on the same part
    for (int i = 0; i < kSamples; ++i) {
      sample_ = std::fmod(sample_ + kGoldenSection, 1.0);
      const ModelTime t = begin + sample_ * (end - begin);
      if (t < end && !check_depth(t)) return false;
    }
    return true;
  }

  // Against the most that was ever turned over, in the holder's frame too: what the drag takes back, and what a slow
  // tip has over a fast holder, leaves its rounding behind.
  bool check_energy() {
    turnover_ = std::max({turnover_, balance_.turnover(tip_), 0.5 * tip_.eta() * tip_.eta()});
    const double part = balance_.imbalance(tip_) / turnover_;
    count_.worst_imbalance = std::max(count_.worst_imbalance, part);
    if (part > kMostImbalance)
      return violated("energy from nothing: " + std::to_string(part * 1e9) + "e-9 of the turnover");
    const double of_segment = balance_.worst_segment();
    return of_segment <= kMostImbalance ||
           violated("energy from nothing: " + std::to_string(of_segment * 1e9) + "e-9 of the turnover of a segment");
  }

  bool check_rate() {
    if (tip_.now().tau != tau_) segments_this_tau_ = 0;
    tau_ = tip_.now().tau;
    count_.most_segments_in_a_tau = std::max(count_.most_segments_in_a_tau, ++segments_this_tau_);
    return segments_this_tau_ <= kMostSegmentsInATau || violated("it stalls");
  }

  void enter(Outcome outcome) {
    ++count_.segments;
    if (outcome == Outcome::impact || outcome == Outcome::contact || outcome == Outcome::released) ++count_.events;
    if (outcome != Outcome::impact) return;
    ++count_.impacts;
    count_.bounces += tip_.last_impact().count;
  }

  Tip tip_;
  EnergyBalance balance_;
  TipCount count_;
  std::uint64_t segments_this_tau_ = 0;
  std::int64_t tau_ = 0;
  double sample_ = 0.0, turnover_ = kLeastTurnover;
  std::string violation_;
};

}  // namespace afm
