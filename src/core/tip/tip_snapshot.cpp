// A tip at a time, and a tip made from that.
#include <cmath>

#include "afm/tip.h"

namespace afm {

using namespace detail;

namespace {

// The fall of v^2/2 since the first bounce of a chatter sequence. A snapshot holds the energy lost beyond it.
double fall_of_energy(double first, double v) { return 0.5 * (first - v) * (first + v); }

}  // namespace

std::vector<ParameterError> find_faults(const TipSnapshot& s, const Model& model) {
  std::vector<ParameterError> faults;
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  require(is_possible(s.time), "time", s.time - ModelTime{}, "is no model time");
  require(s.state.phase >= 0.0 && s.state.phase < 1.0, "surface_phase", s.state.phase, "must be within [0, 1)");
  // A choice, far beyond every run: a thousand times the fastest drag. Commands in step with the spring reach ten
  // times.
  const auto require_within = [&](const char* name, double value, double most) {
    require(std::abs(value) <= most, name, value, "no run reaches it");
  };
  constexpr double kMost = 1000.0 * kMaxEta;
  require_within("extension", s.state.X, kMost + longest_extension(model));
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

bool Tip::is_settled() const { return !pending_ && !(is_on_slide() && start_ + end_ <= now_); }

TipSnapshot Tip::snapshot() const {
  TipSnapshot s;
  s.time = now_;
  s.state = tip_state();
  if (const Flying* flying = std::get_if<Flying>(&phase_); flying != nullptr && now_ == start_) {
    s.state = flying->flight.launch();
  }
  if (std::holds_alternative<Touching>(phase_)) s.phase = TipSnapshot::Phase::touching;
  if (in_contact()) s.phase = TipSnapshot::Phase::contact;
  const Chattering* chattering = std::get_if<Chattering>(&phase_);
  if (chattering == nullptr) return s;
  const Chatter chatter = chatter_now(*chattering);
  const SequenceState now = sequence_state(*chattering, now_ - start_, chatter);
  s.phase = TipSnapshot::Phase::chatter;
  s.state = {wrap_phase(now.displaced.phase), now.displaced.X, now.displaced.u, 0.0, 0.0};
  s.sequence_normal_speed = now.sequence.normal_speed;
  s.sequence_gain = now.sequence.loss - fall_of_energy(now.sequence.normal_speed, now.v);
  s.chatter_speed = now.v;
  s.chatter_count = chatter.n;
  return s;
}

Tip::Tip(const Model& model, double eta, const TipSnapshot& start, double contact_tolerance,
         const Thermostat& thermostat)
    : Tip(model, eta, start.state, contact_tolerance) {
  now_ = start.time;
  thermostat_ = thermostat;
  // the phase is known: a bounce begins no other chatter sequence
  const SlideState<double> reference{start.state.phase, start.state.X, start.state.u};
  switch (start.phase) {
    case TipSnapshot::Phase::flight:
      fly(start.state);
      break;
    case TipSnapshot::Phase::touching:
      touch(constrained(start.state));
      break;
    case TipSnapshot::Phase::contact:
      slide(reference);
      break;
    case TipSnapshot::Phase::chatter:
      chatter_along(reference, {start.chatter_speed, start.chatter_count},
                    {start.sequence_normal_speed,
                     start.sequence_gain + fall_of_energy(start.sequence_normal_speed, start.chatter_speed), 0.0},
                    {});
      split_record();
  }
}

}  // namespace afm
