// A small recording, with messages altered, lost, doubled, moved and cut: replay_check and bag_check end in words, and
// what is not as it was published is never called identical.
#include <topic_tools/shape_shifter.h>
#include <unistd.h>

#include "tools/audit/bag_audit.h"
#include "bytes.h"
#include "node/wire/arithmetic_digest.h"
#include "node/wire/checkpoint_message.h"
#include "node/wire/message_conversion.h"
#include "node/wire/run_digest.h"
#include "tools/replay/run_check.h"
#include "target.h"

#include <sys/mman.h>

namespace {

using namespace afm;  // NOLINT: a program of its own
using fuzz::require;
using replay::Problem;
using replay::Verdict;

struct Entry {
  std::string topic;
  const char *type, *md5sum, *definition;
  std::vector<std::uint8_t> bytes;
};
using Entries = std::vector<Entry>;

class Writer {
 public:
  template <class Message>
  void put(const std::string& topic, Message message) {
    message.header.seq = sequences_[topic]++;
    message.header.stamp = ros::Time(1000, static_cast<std::uint32_t>(entries.size()) * 1000);
    Entry entry{"/afm/" + topic, ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(),
                ros::message_traits::definition<Message>(), {}};
    entry.bytes.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(entry.bytes.data(), static_cast<std::uint32_t>(entry.bytes.size()));
    ros::serialization::serialize(stream, message);
    entries.push_back(entry);
  }
  void mark(std::uint8_t kind) {
    afm_emulator::Recording mark;
    mark.kind = kind;
    mark.messages = entries.size();
    mark.name = "fuzz";
    put("recording", mark);
  }

  Entries entries;

 private:
  std::map<std::string, std::uint32_t> sequences_;
};

// As the node would record it: three batches, a command after each of them, a digest, a status. One that is begun late
// begins with a checkpoint, after a batch and a command that it does not hold.
Entries make_recording(bool late) {
  node::Parameters parameters;
  parameters.time_scale = 0.05;  // small batches: 10 samples in a third of a tau
  parameters.batch_rate_hz = 1000.0;
  const Units units(parameters.si);
  Emulator emulator(node::emulator_settings(parameters));
  Writer out;
  node::RunDigest digest;
  double drag_velocity = parameters.drag_velocity;
  bool recorded = true;
  const auto send = [&](const char* topic, const auto& message) {
    digest.add(message);
    if (recorded) out.put(topic, message);
  };
  const auto tell_drag = [&](const Batch& batch) {
    node::StepperState state;
    state.time = emulator.now();
    state.impacts = batch.first_impact + batch.impacts.size();
    send("applied_drag", node::to_applied_drag(state, drag_velocity, {node::full_level(parameters)}, units, {}));
  };
  out.mark(afm_emulator::Recording::BEGUN);
  const auto configuration = node::to_configuration(parameters, "fuzz", node::arithmetic_digest(), {});
  digest = node::RunDigest(configuration);
  out.put("configuration", configuration);
  Batch batch;
  const auto tell_checkpoint = [&](std::uint64_t drags, std::uint32_t recorded_drags) {
    node::CheckpointContext context;
    context.drags = drags;
    context.next_drag = recorded_drags;
    context.drag_velocity = drag_velocity;
    context.live = node::live_parameters(parameters);
    SavedState state;
    emulator.save(state);
    out.put("checkpoint", node::to_checkpoint(context, emulator.now(), emulator.impacts(), emulator.samples(), digest, state));
  };
  recorded = !late;
  tell_drag({});
  if (late) {
    emulator.run_batch(batch);
    send("deflection", node::to_deflection(batch, 1.0 / parameters.sample_rate_hz, units, {}));
    send("impacts", node::to_impacts(batch, units, {}));
    send("friction", node::to_friction(batch, drag_velocity, units, {}));
    tell_checkpoint(1, 0);
  }
  recorded = true;
  for (int i = 0; i < 3; ++i) {
    emulator.run_batch(batch);
    send("deflection", node::to_deflection(batch, 1.0 / parameters.sample_rate_hz, units, {}));
    send("impacts", node::to_impacts(batch, units, {}));
    send("friction", node::to_friction(batch, drag_velocity, units, {}));
    drag_velocity = 1e-6 * (i + 2);
    emulator.drag(node::to_eta(drag_velocity, parameters.si));
    tell_drag(batch);
    if (i == 1) tell_checkpoint(3, late ? 2 : 3);
  }
  out.put("status", afm_emulator::EmulatorStatus{});
  out.put("digest", digest.message());
  out.mark(afm_emulator::Recording::CLOSED);
  return out.entries;
}

constexpr std::size_t kHeader = 16;  // sequence number, stamp and an empty name before what a message tells

// Whether this byte of a message tells something of the run.
bool tells(const Entry& e, std::size_t at) {
  constexpr std::size_t kBeforeDigest = 148;  // in a checkpoint: the digests in it have a header too, which is empty
  if (e.topic == "/afm/checkpoint") return at >= kHeader && (at < kBeforeDigest || at >= kBeforeDigest + kHeader);
  const bool of_the_run = e.topic == "/afm/deflection" || e.topic == "/afm/impacts" || e.topic == "/afm/friction";
  return of_the_run && at >= kHeader;
}

// One edit, described in `story`. Returns whether it changed what a batch holds.
bool edit(Entries& entries, fuzz::Bytes& bytes, std::string& story) {
  if (entries.empty()) return false;
  const std::size_t op = bytes.below(8), index = bytes.below(entries.size());
  Entry& entry = entries[index];
  const auto here = entries.begin() + static_cast<std::ptrdiff_t>(index);
  if (op == 0) entries.erase(here);
  if (op == 1) entries.insert(here, Entry(entry));
  if (op == 2 && index > 0) std::swap(entries[index - 1], entry);
  if (op < 3 || entry.bytes.empty()) return false;
  const std::size_t at = bytes.raw<std::uint16_t>() % entry.bytes.size();
  story += "; edit " + std::to_string(op) + " at byte " + std::to_string(at) + " of " +
           std::to_string(entry.bytes.size()) + " of message " + std::to_string(index) + ", " + entry.topic;
  const std::vector<std::uint8_t> before = entry.bytes;
  if (op == 3) entry.bytes[at] = static_cast<std::uint8_t>(entry.bytes[at] ^ (1u << bytes.below(8)));
  if (op == 4) entry.bytes[at] = bytes.raw<std::uint8_t>();
  if (op == 5) entry.bytes.resize(std::max<std::size_t>(1, at));
  if (op >= 6) {
    const auto value = op == 6 ? bytes.raw<std::uint64_t>() : bytes.raw<std::uint32_t>();
    std::memcpy(entry.bytes.data() + at, &value, std::min<std::size_t>(op == 6 ? 8 : 4, entry.bytes.size() - at));
  }
  return before != entry.bytes && tells(entry, at);
}

void write(const Entries& entries, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  std::uint32_t n = 0;
  for (const Entry& e : entries) {
    topic_tools::ShapeShifter message;
    message.morph(e.md5sum, e.type, e.definition, "0");
    std::vector<std::uint8_t> bytes = e.bytes;
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.read(stream);
    bag.write(e.topic, ros::Time(1000, 1000 * n++), message);
  }
}

// What a tool would end with; no exception but those that the tools catch.
template <class Check>
Verdict verdict_of(const std::string& path, const Check& check) {
  try {
    Verdict worst = Verdict::sound;
    for (const auto& recording : replay::open_recordings({path}, "")) {
      const Verdict verdict = check(recording);
      if (verdict != Verdict::sound) worst = verdict;
    }
    return worst;
  } catch (const Problem& problem) {
    return problem.verdict;
  } catch (const std::exception&) {
    return Verdict::truncated;
  }
}

Verdict judge_replay(const replay::Recording& recording) {
  replay::RunCheck check(recording, [](double, const ModelTime&) {});
  check.run();
  if (check.difference()) return check.difference()->altered.value_or(false) ? Verdict::altered : Verdict::differs;
  return check.gaps().messages > 0 ? Verdict::missing : recording.is_closed() ? Verdict::sound : Verdict::truncated;
}

Verdict judge_audit(const replay::Recording& recording) {
  audit::BagAudit bag(recording);
  for (const auto& finding : bag.run()) {
    if (finding.kind == audit::Finding::Kind::bad) return Verdict::differs;
  }
  return Verdict::sound;
}

std::string memory_file(const char* name) { return "/proc/self/fd/" + std::to_string(memfd_create(name, 0)); }

}  // namespace

namespace {

void try_edits(const Entries& recording, const std::uint8_t* data, std::size_t size) {
  static const std::string path = memory_file("bag");
  // rosbag loads its plugins with the first bag and unloads them with the last: one stays
  static const rosbag::Bag plugins(memory_file("plugins"), rosbag::bagmode::Write);
  fuzz::Bytes bytes(data, size);
  Entries entries = recording;
  std::string story;
  int edits = 0;
  bool altered = false;
  for (; !bytes.empty() && edits < 8; ++edits) altered = edit(entries, bytes, story);
  write(entries, path);
  const Verdict replayed = verdict_of(path, judge_replay), audited = verdict_of(path, judge_audit);
  if (edits == 0) require(replayed == Verdict::sound && audited == Verdict::sound, "the recording itself is not sound");
  if (edits == 1 && altered) require(replayed != Verdict::sound, "altered, and called identical" + story);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Entries recording = make_recording(false), late = make_recording(true);
  try_edits(recording, data, size);
  if (size % 2 == 1 || size == 0) try_edits(late, data, size);  // it takes as long again
  return 0;
}
