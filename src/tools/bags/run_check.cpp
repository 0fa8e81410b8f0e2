#include "run_check.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <limits>
#include <map>

#include "afm/fingerprint.h"
#include "afm/units.h"
#include "node/params/table.h"
#include "node/publisher/messages.h"

namespace afm::bags {
namespace {

using node::from_message;
using node::to_message;

// Number and stamp are what a run does not know: the second message gets those of the first.
template <class Message>
bool is_same(const Message& recorded, Message& simulated) {
  simulated.header.seq = recorded.header.seq;
  simulated.header.stamp = recorded.header.stamp;
  return same_bytes(ros::serialization::serializeMessage(recorded), ros::serialization::serializeMessage(simulated));
}

// [tau] so little behind a time all impacts at it are taken, and none is waited for that never comes.
constexpr double kJustAfter = 1e-15;
constexpr Number kBehindAll{std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::uint32_t>::max()};

std::string to_text(const afm_emulator::ModelTime& time, std::uint32_t epoch) {
  char text[96];
  std::snprintf(text, sizeof text, "model time %" PRId64 " + %.17g tau of epoch %" PRIu32, time.tau, time.phase, epoch);
  return text;
}

std::string to_text(const afm_emulator::Applied& applied) {
  char text[96];
  std::snprintf(text, sizeof text, "number %" PRIu64 ", %s, drag velocity %.17g m/s, at ", applied.number,
                applied.cause.c_str(), applied.drag_velocity);
  return text + to_text(applied.time, applied.epoch);
}

// Throws Problem if no run has these.
void require_possible(const node::Parameters& parameters, const RunSettings& settings, const std::string& where) {
  const node::Faults faults = node::find_faults(parameters);
  if (!faults.empty()) throw Problem(where + ": " + node::describe(faults));
  for (const ParameterError& fault : find_faults(settings)) throw Problem(where + ": " + fault.what());
}

void require_same_arithmetic(const afm_emulator::Configuration& recorded) {
  static const std::string fingerprint = arithmetic_fingerprint();
  if (recorded.version == AFM_EMULATOR_VERSION && recorded.arithmetic_digest == fingerprint) return;
  throw Problem("it was made by version " + recorded.version + " with the arithmetic " + recorded.arithmetic_digest +
                "; this is version " AFM_EMULATOR_VERSION " with " + fingerprint);
}

}  // namespace

RunCheck::RunCheck(const Recording& recording, Progress progress, double most_gap)
    : recording_(recording), progress_(std::move(progress)), most_gap_(most_gap) {
  if (!recording.holds<afm_emulator::Snapshot>()) throw Problem("it holds no snapshot to begin at");
  if (!recording.holds<afm_emulator::Applied>()) throw Problem("it holds no message of what was applied");
  if (!recording.holds<afm_emulator::Friction>()) {
    throw Problem("it holds no message of friction, which says where each batch ends");
  }
  read_marks();
  batches_ = recording.read<afm_emulator::Friction>();
  deflections_ = recording.read<afm_emulator::Deflection>();
  impacts_ = recording.read<afm_emulator::ImpactArray>();
}

// In the order of the run: a snapshot stands behind all that was applied before it.
void RunCheck::read_marks() {
  const auto snapshots = recording_.read<afm_emulator::Snapshot>();
  for (; snapshots->get(); snapshots->next()) {
    if (!marks_.empty()) marks_.back().lost_snapshots = snapshots->lost();
    marks_.push_back({snapshots->number(), nullptr, snapshots->get(), snapshots->is_repeated()});
  }
  const auto applied = recording_.read<afm_emulator::Applied>();
  std::uint64_t known_lost = 0;
  for (; applied->get(); applied->next()) {
    if (!marks_.empty() && applied->lost() == 0) check_number(marks_.back(), *applied->get(), applied->number());
    marks_.push_back({applied->number(), applied->get(), nullptr, applied->is_repeated()});
    unplaced_commands_ += applied->lost();
  }
  const auto key = [](const Mark& c) {
    return std::make_tuple(c.number.start, c.epoch(), c.in_force().number, c.snapshot != nullptr, c.number.seq);
  };
  for (const Mark& c : marks_) known_epochs_.insert({c.number.start, c.epoch()});
  std::sort(marks_.begin(), marks_.end(), [&](const Mark& a, const Mark& b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < marks_.size(); ++i) {
    const Mark& next = marks_[i];
    Mark& c = marks_[i - 1];
    if (next.number.start != c.number.start || next.epoch() != c.epoch()) continue;
    const std::uint64_t expected = c.in_force().number + (next.applied ? 1 : 0), number = next.in_force().number;
    if (number > expected) known_lost += c.lost_commands = number - expected;
  }
  unplaced_commands_ -= std::min(unplaced_commands_, known_lost);
  lose("commands", recording_.commands_missing_at_beginning());
}

// What is applied is counted in each epoch.
void RunCheck::check_number(const Mark& before, const afm_emulator::Applied& applied, const Number& number) {
  if (!before.applied || before.number.start != number.start) return;
  afm_emulator::Applied expected = applied;
  const bool same = applied.epoch == before.epoch();
  expected.epoch = before.epoch() + (same ? 0 : 1);
  expected.number = same ? before.applied->number + 1 : 0;
  compare(applied, expected);
}

// Each stands in the snapshots of its epoch too. There is one an epoch, so its number is that of the epoch.
void RunCheck::check_configurations() {
  if (!recording_.holds<afm_emulator::Configuration>()) return;
  std::map<std::pair<std::uint64_t, std::uint32_t>, const Mark*> first;  // snapshot of an epoch
  for (const Mark& c : marks_) {
    if (c.snapshot) first.emplace(std::make_pair(c.number.start, c.snapshot->epoch), &c);
  }
  const auto messages = recording_.read<afm_emulator::Configuration>();
  Number last;
  for (; messages->get() && !difference_; messages->next()) {
    lose("configurations", messages->lost());
    last = messages->number();
    const auto found = first.find({messages->number().start, messages->number().seq});
    if (found == first.end()) continue;
    compare(*messages->get(), found->second->snapshot->configuration);
    if (difference_) {
      difference_->time = "the beginning; \"simulated\" is what message " + std::to_string(found->second->number.seq) +
                          " of " + recording_.topic<afm_emulator::Snapshot>() + " holds, and either may be wrong";
    }
  }
  for (auto behind = first.upper_bound({last.start, last.seq}); behind != first.end(); ++behind) {
    if (behind->first.first == last.start) lose("configurations", 1);
  }
}

void RunCheck::run() {
  check_configurations();
  while ((batches_->get() || next_mark_ < marks_.size()) && !difference_) {
    const bool is_mark = !batches_->get() || (next_mark_ < marks_.size() && is_due(marks_[next_mark_]));
    if (is_mark) {
      take(marks_[next_mark_++]);
    } else {
      check_batch();
      progress_(batches_->read_so_far(), batches_->size());
    }
    if (!difference_ || !(is_doubtful_ || is_behind_hole_)) continue;
    difference_.reset();  // it is what the lost command or snapshot did
    run_.reset();
    if (is_mark) ++extent_.commands_unknown;
  }
  if (difference_) return;
  check_without_friction();
  lose("commands", unplaced_commands_, "the beginning of an epoch");
  check_ends<afm_emulator::Friction>();
  check_ends<afm_emulator::Deflection>();
  check_ends<afm_emulator::ImpactArray>();
}

// True if it comes before the next batch. A batch of an epoch of which nothing else is known comes before all.
bool RunCheck::is_due(const Mark& c) const {
  const afm_emulator::Friction& batch = *batches_->get();
  if (known_epochs_.count({batches_->number().start, batch.epoch}) == 0) return false;
  const auto place = [](std::uint64_t start, std::uint32_t epoch, const auto& time, std::uint64_t impacts) {
    return std::make_tuple(start, epoch, time.tau, time.phase, impacts);
  };
  const auto next = place(batches_->number().start, batch.epoch, batch.begin, batch.first_impact);
  return (c.applied ? place(c.number.start, c.epoch(), c.applied->time, c.applied->first_impact)
                    : place(c.number.start, c.epoch(), c.snapshot->time, c.snapshot->next_impact)) <= next;
}

void RunCheck::take(const Mark& mark) {
  if (is_doubtful_ || mark.number.start != start_ || mark.epoch() != applied_.epoch) run_.reset();
  if (mark.snapshot) {
    take_snapshot(mark);
  } else {
    const afm_emulator::Snapshot* behind = snapshot_behind(mark);
    const bool is_first = mark.applied->number == 0 && behind != nullptr && from_message(behind->time) == ModelTime{};
    if (!run_ && is_first) begin_epoch(mark, behind->configuration);
    if (run_) {
      take_applied(*mark.applied);
    } else if (behind == nullptr || behind->applied.number != mark.applied->number) {  // else begin_at() compares it
      ++extent_.commands_unknown;
    }
  }
  lose("commands", mark.lost_commands);
  lose("snapshots", mark.lost_snapshots);
  is_doubtful_ = mark.lost_commands + mark.lost_snapshots > 0;
}

// The next mark, if it is a snapshot of the same epoch.
const afm_emulator::Snapshot* RunCheck::snapshot_behind(const Mark& mark) const {
  if (next_mark_ == marks_.size()) return nullptr;
  const Mark& next = marks_[next_mark_];
  return next.number.start == mark.number.start && next.epoch() == mark.epoch() ? next.snapshot.get() : nullptr;
}

// The epoch is simulated from its configuration, and its first snapshot is compared too.
void RunCheck::begin_epoch(const Mark& mark, const afm_emulator::Configuration& configuration) {
  configuration_ = configuration;
  require_same_arithmetic(configuration_);
  in_force_ = node::to_parameters(configuration_);
  const RunSettings settings = node::run_settings(in_force_);
  require_possible(in_force_, settings, "the configuration of epoch " + std::to_string(mark.epoch()));
  run_.emplace(settings);
  note_beginning(mark);
  applied_ = *mark.applied;
}

void RunCheck::begin_at(const Mark& mark) {
  const afm_emulator::Snapshot& snapshot = *mark.snapshot;
  configuration_ = snapshot.configuration;
  require_same_arithmetic(configuration_);
  in_force_ = node::to_parameters(configuration_);
  node::apply_to(in_force_, snapshot.applied);
  const Snapshot state = from_message(snapshot);
  const std::string where = "the snapshot at " + to_text(snapshot.time, snapshot.epoch);
  require_possible(in_force_, state.settings, where);
  try {
    run_.emplace(state);
  } catch (const ParameterError& fault) {
    throw Problem(where + ": " + fault.what());
  }
  note_beginning(mark);
  applied_ = snapshot.applied;
  // of its own epoch, and of nothing but what it says
  compare(snapshot, node::to_snapshot(state, configuration_, applied_, {snapshot.header.stamp, applied_.epoch}));
  const Mark* before = next_mark_ >= 2 ? &marks_[next_mark_ - 2] : nullptr;
  if (!before || !before->applied || before->number.start != start_ || before->epoch() != applied_.epoch) return;
  if (before->applied->number == applied_.number) compare(*before->applied, applied_);
}

void RunCheck::note_beginning(const Mark& mark) {
  if (extent_.epochs == 0 || mark.number.start != start_ || mark.epoch() != applied_.epoch) ++extent_.epochs;
  start_ = mark.number.start;
  has_begun_ = true;
  has_begun_at_repeated_ = mark.is_repeated;
  is_behind_hole_ = false;
  last_.reset();
}

// All that its cause does not change. Without an effect it would not show in the run.
void RunCheck::keep_what_was_in_force(afm_emulator::Applied& applied) const {
  const bool begins = applied.cause == "epoch", by_parameters = applied.cause == "parameters";
  const double rest_height = applied.rest_height_m;
  if (!by_parameters) node::for_each_live(applied, in_force_, node::kToMessage);
  if (!by_parameters && !begins) applied.rest_height_m = rest_height;
  if (by_parameters || begins) applied.drag_velocity = in_force_.drag_velocity;
  if (in_force_.model == node::kAuto) return;
  applied.model = applied_.model;
  applied.contact_tolerance = applied_.contact_tolerance;
}

void RunCheck::take_applied(const afm_emulator::Applied& applied) {
  run_to(applied.time, applied.first_impact);
  afm_emulator::Applied simulated = applied;
  keep_what_was_in_force(simulated);
  const RunSettings settings = node::apply_to(in_force_, applied);
  require_possible(in_force_, settings, "what was applied at " + to_text(applied.time, applied.epoch));
  simulated.time = to_message(run_->now());
  simulated.first_impact = run_->impacts();
  simulated.first_sample = run_->samples();
  simulated.energy_dropped = run_->apply(settings) * Units(in_force_.si).energy();
  simulated.samples_per_batch = settings.samples_per_batch;
  simulated.sample_period_tau = settings.sample_period;
  if (in_force_.model != node::kAuto) simulated.expected_error = std::numeric_limits<double>::quiet_NaN();
  compare(applied, simulated);
  applied_ = applied;
  last_.reset();
  ++extent_.commands;
}

void RunCheck::take_snapshot(const Mark& mark) {
  if (!run_) return begin_at(mark);
  const afm_emulator::Snapshot& snapshot = *mark.snapshot;
  run_to(snapshot.time, snapshot.next_impact);
  settle();
  if (difference_) return;
  compare(snapshot,
          node::to_snapshot(run_->split(), configuration_, applied_, {snapshot.header.stamp, applied_.epoch}));
  ++extent_.snapshots;
}

// An event that is due now comes first, in a batch of no length.
void RunCheck::settle() {
  while (!run_->can_split() && !difference_) {
    const auto batch = batches_->get();
    if (batch && from_message(batch->begin) == run_->now() && batch->first_impact == run_->impacts()) {
      check_batch();
    } else {
      run_->advance(run_->now(), run_->settings().impact_budget, batch_);
    }
  }
}

// The next one.
void RunCheck::check_batch() {
  const auto recorded = batches_->get();
  const Number number = batches_->number();
  const bool follows = batches_->lost() == 0 && !has_begun_;
  lose("messages of " + recording_.topic<afm_emulator::Friction>(), batches_->lost(), batches_end_);
  batches_end_ = to_text(recorded->time, recorded->epoch);
  check_without_friction();
  if (is_hole()) is_behind_hole_ = true;
  const auto deflection = of_batch(*deflections_);
  const auto impacts = of_batch(*impacts_);
  batches_->next();
  if (!run_ || number.start != start_ || recorded->epoch != applied_.epoch) {
    ++extent_.batches_unknown;
    has_begun_ = true;  // the next one does not follow what was compared
    return;
  }
  has_begun_ = false;
  if (last_ && !is_doubtful_ && tells_of_command(*last_, *recorded)) {
    lose("commands", 1);
    if (unplaced_commands_ > 0) --unplaced_commands_;
    is_doubtful_ = true;
  }
  if (!follows) run_to(recorded->begin, recorded->first_impact);
  advance(*recorded);
  const Units units(in_force_.si);
  const node::Label label{{}, applied_.epoch};
  if (deflection) compare(*deflection, node::to_deflection(batch_, in_force_, units, label));
  if (impacts) compare(*impacts, node::to_impacts(batch_, units, label));
  compare(*recorded, node::to_friction(batch_, in_force_, units, label));
  if (difference_) {
    ++extent_.batches_unknown;
    return;
  }
  if (impacts && !impacts->impacts.empty()) is_behind_hole_ = false;  // an impact hides no last digit
  last_ = recorded;
  ++extent_.batches;
  extent_.model_seconds += (batch_.end - batch_.begin) * units.time();
  extent_.deflections += deflection ? 1 : 0;
  extent_.samples += deflection ? batch_.vertical.size() : 0;
  extent_.impact_arrays += impacts ? 1 : 0;
  extent_.impacts += impacts ? batch_.impacts.size() : 0;
}

// Whether whole batches are missing before this one, and after the last snapshot of its start: the number of a lost one
// shows by the next alone.
bool RunCheck::is_hole() const {
  const bool begins_later = has_begun_ && run_ && run_->now() < from_message(batches_->get()->begin);
  if (begins_later && has_begun_at_repeated_) return true;
  const auto is_lost = [](const auto& messages) { return !messages->get() || messages->lost() > 0; };
  if (batches_->lost() == 0 || !is_lost(deflections_) || !is_lost(impacts_)) return false;
  return std::none_of(marks_.begin() + static_cast<std::ptrdiff_t>(next_mark_), marks_.end(),
                      [&](const Mark& c) { return c.snapshot && c.number.start == batches_->number().start; });
}

// As the emulator did: no batch has more impacts than its budget, and one that ended by its time has not spent it.
void RunCheck::advance(const afm_emulator::Friction& recorded) {
  ModelTime end = from_message(recorded.time);
  if (!is_possible(end) || end < run_->now()) end = run_->now();
  advance_to(end, recorded.impact_limit);
}

// 0 impacts: however many there are.
void RunCheck::advance_to(const ModelTime& time, std::uint64_t impacts) {
  const std::uint64_t budget = run_->settings().impact_budget;
  if (impacts > 0) {
    run_->advance(time + kJustAfter, std::min(impacts, budget), batch_);
  } else {
    run_->advance(time, budget, batch_);
  }
}

// To where something else begins: at one time there may be several impacts.
void RunCheck::run_to(const afm_emulator::ModelTime& to, std::uint64_t impacts) {
  const ModelTime time = from_message(to);
  if (!is_possible(time) || time - run_->now() > most_gap_) return;
  while (run_->now() < time || (run_->now() == time && run_->impacts() < impacts)) {
    advance_to(time, run_->impacts() < impacts ? impacts - run_->impacts() : 0);
  }
}

// Batches before the next one, or behind the last, of which friction is missing, as at the ends of a bag by
// `rosbag record`. Where they end is not known: they are compared as whole ones, and what differs then counts as not
// compared.
void RunCheck::check_without_friction() {
  std::optional<Run> ahead;
  const auto is_before = [this](const auto& messages, const Number& number) {
    return messages->get() && messages->number() < number;
  };
  const auto is_of = [](const auto& messages, const Number& number) {
    return messages->get() && messages->number() == number;
  };
  const Number end = batches_->get() ? batches_->number() : kBehindAll;
  for (;;) {
    Number next = end;
    if (is_before(deflections_, next)) next = deflections_->number();
    if (is_before(impacts_, next)) next = impacts_->number();
    if (!(next < end)) return;
    const bool of_deflection = is_of(deflections_, next), of_impacts = is_of(impacts_, next);
    const auto deflection = of_deflection ? deflections_->get() : nullptr;
    const auto impacts = of_impacts ? impacts_->get() : nullptr;
    if (run_ && next.start == start_ && !ahead) ahead = run_;
    if (!ahead || !is_whole_batch(deflection.get(), impacts.get(), *ahead)) ++extent_.batches_without_friction;
    if (of_deflection) take_next(*deflections_);
    if (of_impacts) take_next(*impacts_);
  }
}

// Whether the run makes these two, of which one may be missing, of a whole batch.
bool RunCheck::is_whole_batch(const afm_emulator::Deflection* deflection, const afm_emulator::ImpactArray* impacts,
                              Run& run) {
  const std::uint64_t budget = run.settings().impact_budget;
  if (deflection != nullptr) {
    const ModelTime begin = from_message(deflection->time);
    if (!is_possible(begin) || begin - run.now() > most_gap_) return false;
    while (run.now() < begin) run.advance(begin, budget, batch_);
  } else if (batches_->get()) {
    const ModelTime next = from_message(batches_->get()->begin);
    if (!is_possible(next) || next - run.now() > most_gap_) return false;
    while (run.now() < next && run.impacts() < impacts->first_index) run.advance(batch_);
  }
  run.advance(batch_);
  const Units units(in_force_.si);
  const node::Label label{{}, applied_.epoch};
  auto samples = node::to_deflection(batch_, in_force_, units, label);
  auto events = node::to_impacts(batch_, units, label);
  return (deflection == nullptr || is_same(*deflection, samples)) && (impacts == nullptr || is_same(*impacts, events));
}

// The message of the next batch, if it is held.
template <class Message>
boost::shared_ptr<Message> RunCheck::of_batch(Cursor<Message>& messages) {
  if (!messages.get() || !(messages.number() == batches_->number())) return {};
  const boost::shared_ptr<Message> message = messages.get();
  take_next(messages);
  return message;
}

template <class Message>
void RunCheck::check_ends() {
  const std::string what = "messages of " + recording_.topic<Message>();
  const Recording::Missing missing = recording_.missing_at_ends<Message>();
  const std::string of = recording_.has_several_starts() ? " of a start" : " of the recording";
  const auto lose_at = [&](const char* end, std::uint64_t count) {
    if (count > 0) missing_.push_back({what + " at the " + end + of, "", count});
  };
  lose_at("beginning", missing.at_beginning);
  lose_at("end", missing.at_end);
}

template <class Message>
void RunCheck::take_next(Cursor<Message>& messages) {
  messages.next();
  if (messages.get()) lose("messages of " + recording_.topic<Message>(), messages.lost());
}

template <class Message>
void RunCheck::compare(const Message& recorded, Message simulated) {
  if (difference_ || is_same(recorded, simulated)) return;
  difference_ = Difference{recording_.topic<Message>(), recorded.header.seq, find_difference(recorded, simulated),
                           run_ ? to_text(to_message(run_->now()), applied_.epoch) : "the beginning",
                           run_ ? to_text(applied_) : "none"};
}

void RunCheck::lose(const std::string& what, std::uint64_t count, const std::string& after) {
  if (count == 0) return;
  const auto known = std::find_if(missing_.begin(), missing_.end(), [&](const Missing& m) { return m.what == what; });
  if (known != missing_.end()) {
    known->count += count;
  } else {
    const std::string now = run_ ? to_text(to_message(run_->now()), applied_.epoch) : "the beginning";
    missing_.push_back({what, after.empty() ? now : after, count});
  }
}

std::vector<std::string> RunCheck::missing() const {
  std::vector<std::string> lines;
  for (const Missing& m : missing_) {
    lines.push_back(std::to_string(m.count) + " " + m.what + (m.after.empty() ? "" : ", the first after " + m.after));
  }
  return lines;
}

}  // namespace afm::bags
