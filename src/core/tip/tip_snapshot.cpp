// A tip at a time, and a tip made from that.
#include <cmath>

#include "afm/tip.h"

namespace afm {

std::vector<ParameterError> find_faults(const TipSnapshot& s) {
  std::vector<ParameterError> faults;
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  require(is_possible(s.time), "time", s.time - ModelTime{}, "is no model time");
  require(s.state.phase >= 0.0 && s.state.phase < 1.0, "surface_phase", s.state.phase, "must be within [0, 1)");
  // A choice, far beyond every run: a thousand times the fastest drag. Commands in step with the spring reach ten times.
  const auto require_within = [&](const char* name, double value, double most) {
    require(std::abs(value) <= most, name, value, "no run reaches it");
  };
  constexpr double kMost = 1000.0 * kMaxEta;
  require_within("extension", s.state.X, kMost);
  require_within("u", s.state.u, kMost);
  require(s.state.g >= 0.0 && s.state.g <= kMost, "gap", s.state.g, "must not be negative, or beyond every run");
  require_within("gap_rate", s.state.g1, 10.0 * kMost);
  require(s.phase <= TipSnapshot::Phase::touching, "phase", static_cast<double>(s.phase), "is no phase of a tip");
  if (s.phase == TipSnapshot::Phase::flight) return faults;
  require(s.state.g == 0.0 && s.state.g1 == 0.0, "gap", s.state.g, "the tip in contact is on the surface, at rest");
  if (s.phase != TipSnapshot::Phase::chatter) return faults;
  require(s.chatter_speed >= 0.0 && s.chatter_speed <= 1.0, "chatter_speed", s.chatter_speed, "no chatter is so fast");
  require(s.chatter_count >= 0.0 && s.chatter_count <= 0x1p53, "chatter_count", s.chatter_count, "cannot be counted");
  require(s.sequence_normal_speed >= 0.0 && s.sequence_normal_speed <= 1.0, "sequence_normal_speed",
          s.sequence_normal_speed, "no chatter is so fast");
  require(std::isfinite(s.sequence_gain), "sequence_gain", s.sequence_gain, "must be finite");
  return faults;
}

bool Tip::is_settled() const {
  const bool ends_now = (mode_ == Mode::sliding && start_ + slide_end_ <= now_) ||
                        (mode_ == Mode::chattering && start_ + chatter_run_.s <= now_);
  return !pending_ && !ends_now;
}

TipSnapshot Tip::snapshot() const {
  TipSnapshot s;
  s.time = now_;
  s.state = !on_slide() && now_ == start_ ? flight_.launch() : tip_state();
  if (mode_ == Mode::sliding) s.phase = TipSnapshot::Phase::contact;
  if (mode_ == Mode::touching) {
    s.phase = TipSnapshot::Phase::touching;
    s.state.g1 = 0.0;  // but for rounding
  }
  if (mode_ != Mode::chattering) return s;
  const Chatter chatter = chatter_now();
  const SequenceState sequence = sequence_state(now_ - start_, chatter);
  s.phase = TipSnapshot::Phase::chatter;
  s.state = {wrap_phase(sequence.moved.phase), sequence.moved.X, sequence.moved.u, 0.0, 0.0};
  s.sequence_normal_speed = sequence_normal_speed_;
  const double v0 = sequence_normal_speed_, v = sequence.v;
  s.sequence_gain = sequence.loss - 0.5 * (v0 - v) * (v0 + v);
  s.chatter_speed = sequence.v;
  s.chatter_count = chatter.n;
  return s;
}

Tip::Tip(const Model& model, double eta, const TipSnapshot& start, double contact_tolerance,
         const Thermostat& thermostat)
    : Tip(model, eta, start.state, contact_tolerance) {
  now_ = start.time;
  thermostat_ = thermostat;
  begin_flight();  // the phase is known: a bounce begins no other chatter sequence
  if (start.phase == TipSnapshot::Phase::touching) mode_ = Mode::touching;
  const SlideState<double> reference{start.state.phase, start.state.X, start.state.u};
  if (start.phase == TipSnapshot::Phase::contact) slide(reference);
  if (start.phase != TipSnapshot::Phase::chatter) return;
  sequence_normal_speed_ = start.sequence_normal_speed;
  const double v0 = start.sequence_normal_speed, v = start.chatter_speed;
  sequence_loss_ = std::fmax(0.0, start.sequence_gain + 0.5 * (v0 - v) * (v0 + v));
  start_chatter(reference, {start.chatter_speed, start.chatter_count});
  split_account();
}

}  // namespace afm
