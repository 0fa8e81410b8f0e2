// A small recording, with messages altered, lost, doubled, moved and cut: replay_check ends in words, and what is not
// as it was published is never called identical.
#include <afm_emulator/EmulatorStatus.h>
#include <sys/mman.h>
#include <topic_tools/shape_shifter.h>
#include <unistd.h>

#include <cstdlib>
#include <new>

#include "afm/fingerprint.h"
#include "bytes.h"
#include "node/publisher/messages.h"
#include "target.h"
#include "tools/bags/run_check.h"

// An altered length may ask for more memory than any machine has. That fails here above a gigabyte: the address
// sanitizer would end the program instead.
__attribute__((noinline)) void* operator new(std::size_t size) {
  constexpr std::size_t kMemory = std::size_t{1} << 30;
  void* const block = size > kMemory ? nullptr : std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
__attribute__((noinline)) void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // of std::stable_sort
  return std::malloc(size);
}
// not inlined: GCC would see free() of what came from new
__attribute__((noinline)) void operator delete(void* block) noexcept { std::free(block); }
__attribute__((noinline)) void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace {

using namespace afm;  // a program of its own
using fuzz::require;

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
    const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
    entries.push_back({"/afm/" + topic,
                       ros::message_traits::datatype<Message>(),
                       ros::message_traits::md5sum<Message>(),
                       ros::message_traits::definition<Message>(),
                       {bytes.message_start, bytes.buf.get() + bytes.num_bytes}});
  }

  Entries entries;

 private:
  std::map<std::string, std::uint32_t> sequences_;
};

// As the node would record it: three batches, a command after each of them, and a snapshot in the middle.
class Recorded {
 public:
  Recorded() : run_(node::run_settings(parameters_)) {
    configuration_ = node::to_configuration(parameters_, AFM_EMULATOR_VERSION, arithmetic_fingerprint(), {});
    out_.put("configuration", configuration_);
    apply(parameters_.drag_velocity, "epoch");
    put_snapshot();
    for (int i = 0; i < 3; ++i) {
      put_batch();
      apply(1e-6 * (i + 2), "drag_velocity");
      if (i == 1) put_snapshot();
    }
    put_batch();
    out_.put("status", afm_emulator::EmulatorStatus{});
  }

  const Entries& entries() const { return out_.entries; }

 private:
  static node::Parameters small_batches() {
    node::Parameters parameters;  // 10 samples in a third of a tau
    parameters.time_scale = 0.05;
    parameters.batch_rate_hz = 1000.0;
    return parameters;
  }
  void apply(double drag_velocity, const char* cause) {
    node::Report report;
    parameters_.drag_velocity = drag_velocity;
    report.in_force.number = number_++;
    report.in_force.cause = cause;
    report.in_force.live = parameters_;
    report.in_force.level.contact_tolerance = parameters_.contact_tolerance;
    run_.apply(node::run_settings(parameters_));
    report.state.time = run_.now();
    report.state.impacts = run_.impacts();
    report.state.samples = run_.samples();
    applied_ = node::to_applied(report, parameters_, {});
    out_.put("applied", applied_);
  }
  void put_snapshot() {
    while (!run_.can_split()) run_.advance(run_.now(), 1, batch_);
    out_.put("snapshot", node::to_snapshot(run_.split(), configuration_, applied_, {}));
  }
  void put_batch() {
    const Units units(parameters_.si);
    run_.advance(batch_);
    out_.put("deflection", node::to_deflection(batch_, parameters_, units, {}));
    out_.put("impacts", node::to_impacts(batch_, units, {}));
    out_.put("friction", node::to_friction(batch_, parameters_, units, {}));
  }

  node::Parameters parameters_ = small_batches();
  Run run_;
  Writer out_;
  Batch batch_;
  std::uint64_t number_ = 0;
  afm_emulator::Configuration configuration_;
  afm_emulator::Applied applied_;
};

constexpr std::size_t kHeader = 16;  // sequence number, stamp and an empty name before what a message tells

// Whether this byte of a message follows from the run.
bool tells(const Entry& e, std::size_t at) {
  return at >= kHeader && e.topic != "/afm/status" && e.topic != "/afm/applied";
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

// What replay_check would call it; no exception but those that it catches.
bool is_identical(const std::string& path) {
  constexpr double kMostGap = 1e3;  // [tau]: so that no altered time takes long
  try {
    bool identical = true;
    for (const bags::Recording& recording : bags::open_recordings({path}, "")) {
      bags::RunCheck check(
          recording, [](std::size_t, std::size_t) {}, kMostGap);
      check.run();
      identical = identical && !check.difference() && check.missing().empty() && check.extent().batches_unknown == 0 &&
                  check.extent().commands_unknown == 0;
    }
    return identical;
  } catch (const std::exception&) {
    return false;
  }
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
  const bool identical = is_identical(path);
  if (edits == 0) require(identical, "the recording itself is not identical");
  if (edits == 1 && altered) require(!identical, "altered, and called identical" + story);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Recorded recorded;
  try_edits(recorded.entries(), data, size);
  return 0;
}
