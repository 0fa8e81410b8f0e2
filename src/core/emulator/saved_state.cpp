// One list of fields serves writing and reading, so they agree. It leaves out values that follow from others (the
// landing of a flight, the constants of a model). It also leaves out counters and whether samples are taken. So two
// emulators at the same point write the same words, whatever their batches were.
#include "afm/saved_state.h"

#include <cmath>
#include <type_traits>

#include "afm/emulator.h"
#include "state_words.h"

namespace afm {
namespace {

constexpr bool kLp64 = sizeof(void*) == 8;  // the sizes below are those of 64-bit machines

}  // namespace

// Self is const for a writer. After adding or removing a member: add it to its list or say there why not, raise
// kLayoutVersion, and set the size.
class StateFields {
 public:
  template <class Archive, class Self>
  static void of_run(Archive& archive, Self& emulator);
  template <class Archive, class Settings>
  static void of_settings(Archive& archive, Settings& settings);
  template <class Archive, class Self>
  static void of_single_tip(Archive& archive, Self& tip);
  static bool is_possible(const Emulator& emulator);
  static bool is_possible(const Tip& tip);

 private:
  template <class Archive, class T>
  static void whole(Archive& archive, T& object);
  template <class Archive, class T>
  static void choice(Archive& archive, T& value, std::remove_const_t<T> most);
  template <class Archive, class Self>
  static void of_model(Archive& archive, Self& model);
  template <class Archive, class Self>
  static void of_impact(Archive& archive, Self& impact);
  template <class Archive, class Self>
  static void of_tip(Archive& archive, Self& tip, double contact_tolerance, const Bath& bath);
  template <class Archive, class Self>
  static void of_kicks(Archive& archive, Self& thermostat);
};

// An object of doubles and 64-bit numbers only, so without padding: its members in their order.
template <class Archive, class T>
void StateFields::whole(Archive& archive, T& object) {
  static_assert(std::is_trivially_copyable_v<std::remove_const_t<T>>);
  static_assert(alignof(T) == alignof(std::uint64_t) && sizeof(T) % sizeof(std::uint64_t) == 0);
  archive.whole(object);
}

template <class Archive, class T>
void StateFields::choice(Archive& archive, T& value, std::remove_const_t<T> most) {
  if constexpr (std::is_const_v<T>) {
    archive.number(value);
  } else {
    archive.choice(value, most);
  }
}

template <class Archive, class Self>
void StateFields::of_model(Archive& archive, Self& m) {
  static_assert(!kLp64 || sizeof m == 48);
  for (auto* field : {&m.frequency_ratio, &m.H, &m.y0, &m.gamma, &m.v_c}) whole(archive, *field);
  choice(archive, m.kind, ModelKind::hammer);
}

template <class Archive, class Self>
void StateFields::of_impact(Archive& archive, Self& i) {
  static_assert(!kLp64 || sizeof i == 56);
  whole(archive, i.time);
  for (auto* field : {&i.surface_phase, &i.normal_speed, &i.tangential_velocity, &i.energy_loss}) {
    whole(archive, *field);
  }
  choice(archive, i.kind, ImpactKind::contact_ended);
  archive.number(i.count);
}

// Without the bath, which is one of the settings.
template <class Archive, class Self>
void StateFields::of_kicks(Archive& archive, Self& t) {
  static_assert(!kLp64 || sizeof t == 136);
  whole(archive, t.grid_);
  archive.number(t.kicks_);
}

// Without mechanics_ and law_, which follow from the model, without values that follow from the tolerance, and without
// the landing, which follows from the flight.
template <class Archive, class Self>
void StateFields::of_tip(Archive& archive, Self& t, double contact_tolerance, const Bath& bath) {
  constexpr std::size_t kParts = sizeof t.flight_ + sizeof t.slide_ + sizeof t.landing_ + sizeof t.law_ +
                                 sizeof t.mechanics_ + sizeof t.thermostat_;
  static_assert(!kLp64 || sizeof t - kParts == 472);
  of_model(archive, t.model_);
  whole(archive, t.eta_);
  whole(archive, t.flight_);
  whole(archive, t.slide_);
  choice(archive, t.mode_, Tip::Mode::sliding);
  whole(archive, t.start_);
  whole(archive, t.now_);
  whole(archive, t.slide_end_);
  choice(archive, t.slide_releases_, true);
  whole(archive, t.chatter_);
  choice(archive, t.chatter_run_.end, ChatterEnd::exits);
  whole(archive, t.chatter_run_.s);
  whole(archive, t.chatter_run_.chatter);
  whole(archive, t.sequence_begin_);
  for (auto* field : {&t.sequence_normal_speed_, &t.sequence_energy_, &t.sequence_gain_, &t.sequence_impulse_}) {
    whole(archive, *field);
  }
  whole(archive, t.split_);
  choice(archive, t.is_split_, true);
  of_impact(archive, t.last_impact_);
  choice(archive, t.pending_, true);
  of_impact(archive, t.pending_impact_);
  of_kicks(archive, t.thermostat_);
  if constexpr (!std::is_const_v<Self>) {
    t.set_tolerance(contact_tolerance);
    t.set_laws(Model(t.model_));
    t.landing_known_ = false;
    t.thermostat_.bath_ = bath;
    t.thermostat_.prepare(t.model_.frequency_ratio);
  }
}

template <class Archive, class Settings>
void StateFields::of_settings(Archive& archive, Settings& s) {
  static_assert(!kLp64 || sizeof s == 184);
  of_model(archive, s.model);
  whole(archive, s.eta);
  whole(archive, s.initial);
  for (auto* field : {&s.sample_period, &s.friction_window, &s.contact_tolerance}) whole(archive, *field);
  archive.number(s.samples_per_batch);
  archive.number(s.impact_budget);
  whole(archive, s.bath);
}

template <class Archive, class Self>
void StateFields::of_run(Archive& archive, Self& e) {
  static_assert(!kLp64 || sizeof e - sizeof e.settings_ - sizeof e.tip_ - sizeof e.friction_ == 104);
  of_settings(archive, e.settings_);
  whole(archive, e.eta_);
  of_tip(archive, e.tip_, e.settings_.contact_tolerance, e.settings_.bath);
  whole(archive, e.friction_);
  whole(archive, e.now_);
  whole(archive, e.grid_);
  archive.number(e.next_sample_);
  archive.number(e.impact_index_);
}

// Of a tip by itself, the tolerance and the bath too.
template <class Archive, class Self>
void StateFields::of_single_tip(Archive& archive, Self& t) {
  Bath bath = t.thermostat_.bath_;
  double slowest_chatter = t.slowest_chatter_, entry_speed = t.entry_speed_;
  whole(archive, bath);
  whole(archive, slowest_chatter);
  whole(archive, entry_speed);
  of_tip(archive, t, 0.0, bath);
  if constexpr (!std::is_const_v<Self>) {
    t.slowest_chatter_ = slowest_chatter;
    t.entry_speed_ = entry_speed;
    t.set_laws(Model(t.model_));
  }
}

std::uint32_t state_layout() {
  constexpr std::uint32_t kLayoutVersion = 6;  // to be raised if the words get another meaning
  static const std::uint32_t layout = [] {
    SavedState state;
    Emulator(EmulatorSettings{}).save(state);
    return kLayoutVersion * 1000 + static_cast<std::uint32_t>(state.size);
  }();
  return layout;
}

namespace {

bool is_time(const ModelTime& time) {
  return time.tau >= 0 && time.tau <= kEndOfTime.tau && time.phase >= 0.0 && time.phase < 1.0;
}

}  // namespace

// True: a run from this state ends and stays within its memory. Other faults show in the run.
bool StateFields::is_possible(const Tip& tip) {
  const bool in_time = is_time(tip.now_) && is_time(tip.start_) && tip.start_ <= tip.now_;
  const bool ends = std::isfinite(tip.slide_end_) && std::isfinite(tip.chatter_run_.s);
  const Thermostat& kicks = tip.thermostat_;
  const bool on_time =
      !kicks.bath_.is_on() || (kicks.grid_.period == 1.0 / kicks.bath_.kicks_per_tau && is_time(kicks.grid_.origin) &&
                               kicks.grid_.first <= kicks.kicks_ && kicks.grid_.time_or_end(kicks.kicks_) <= tip.now_ &&
                               tip.now_ <= kicks.next());
  return in_time && ends && on_time && find_faults(tip.model_).empty() && find_faults(kicks.bath_).empty() &&
         std::abs(tip.eta_) <= kMaxEta;
}

bool StateFields::is_possible(const Emulator& e) {
  const Tip& tip = e.tip_;
  const bool in_time = tip.now_ == e.now_ && is_time(e.grid_.origin) && e.grid_.origin <= e.now_;
  const std::uint64_t next = e.next_sample_;
  const bool on_grid = e.grid_.period == e.settings_.sample_period && e.grid_.first <= next &&
                       e.now_ <= e.grid_.time_or_end(next) && e.grid_.time_or_end(next) < kEndOfTime &&
                       (next == e.grid_.first || e.grid_.time(next - 1) < e.now_);
  return is_possible(tip) && in_time && on_grid && tip.model_.kind == e.settings_.model.kind && tip.eta_ == e.eta_ &&
         e.friction_.is_possible(e.now_, e.settings_.friction_window);
}

void Tip::save(SavedState& out) const {
  Writer writer(out);
  StateFields::of_single_tip(writer, *this);
}

std::optional<Tip> Tip::restored(const SavedState& state) {
  Tip tip(Model{}, 0.0, EmulatorSettings{}.initial);
  Reader reader(state);
  StateFields::of_single_tip(reader, tip);
  if (!reader.valid() || !StateFields::is_possible(tip)) return {};
  return tip;
}

void Emulator::save(SavedState& out) const {
  // a word for each member at most; few members are shorter than a word
  static_assert(sizeof(Emulator) / sizeof(std::uint64_t) + 64 <= SavedState::kMaxWords);
  Writer writer(out);
  StateFields::of_run(writer, *this);
}

std::optional<Emulator> Emulator::restored(const SavedState& state) {
  EmulatorSettings settings;
  Reader beginning(state), reader(state);
  StateFields::of_settings(beginning, settings);
  if (!find_faults(settings).empty()) return {};
  Emulator emulator(settings);
  StateFields::of_run(reader, emulator);
  if (!reader.valid() || !StateFields::is_possible(emulator)) return {};
  return emulator;
}

}  // namespace afm
