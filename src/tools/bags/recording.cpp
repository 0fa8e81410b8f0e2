#include "recording.h"

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/EmulatorStatus.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/Snapshot.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <regex>
#include <set>

#include "node/publisher/topics.h"

namespace afm::bags {
namespace {

using File = Recording::File;

constexpr double kMostTold = 1e15;  // batches: more are a damaged time

template <class... Messages>
std::map<std::string, std::string> md5sums() {
  return {{ros::message_traits::datatype<Messages>(), ros::message_traits::md5sum<Messages>()}...};
}

// The types that are read here, and the definitions that this program has of them.
const std::map<std::string, std::string> kTypes =
    md5sums<afm_emulator::Applied, afm_emulator::Configuration, afm_emulator::Deflection, afm_emulator::EmulatorStatus,
            afm_emulator::Friction, afm_emulator::ImpactArray, afm_emulator::Snapshot>();
const auto kBatchTypes = md5sums<afm_emulator::Deflection, afm_emulator::Friction, afm_emulator::ImpactArray>();

// Why it is no bag, or nothing.
std::string find_fault(const std::string& path) {
  if (!std::filesystem::exists(path)) return "there is no such file";
  if (std::filesystem::is_directory(path)) return "is a directory";
  std::string begin(4, ' ');
  std::ifstream(path).read(begin.data(), 4);
  return begin == "#ROS" ? "" : "is not a bag, or cannot be read";
}

std::string callerid(const rosbag::ConnectionInfo& connection) {
  if (!connection.header) return "";
  const auto found = connection.header->find("callerid");
  return found == connection.header->end() ? "" : found->second;
}

// rosbag record repeats latched messages without the name of their node: it is that of its namespace.
std::map<std::uint32_t, std::string> nodes_of(const rosbag::Bag& bag) {
  const auto space = [](const rosbag::ConnectionInfo& c) { return c.topic.substr(0, c.topic.rfind('/')); };
  std::map<std::string, std::string> named;
  std::map<std::uint32_t, std::string> nodes;
  const auto connections = rosbag::View(bag).getConnections();
  for (const rosbag::ConnectionInfo* c : connections) {
    if (kTypes.count(c->datatype) > 0 && !callerid(*c).empty()) named[space(*c)] = callerid(*c);
  }
  for (const rosbag::ConnectionInfo* c : connections) {
    nodes[c->id] = callerid(*c).empty() ? named[space(*c)] : callerid(*c);
  }
  return nodes;
}

// All bags stay open. A recording that was split every minute uses up the usual 1024 files in a day, and then rosbag
// says that a plugin is missing.
void require_files_for(std::size_t bags) {
  constexpr rlim_t kOthers = 16;  // of the program itself
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
  if (bags + kOthers <= files.rlim_max) return;
  throw Problem(std::to_string(bags) + " bags: only " + std::to_string(files.rlim_max) +
                " files may be open at once; raise the limit (ulimit -n)");
}

File open(const std::string& path) {
  File file{path, std::make_shared<rosbag::Bag>(), {}};
  std::string fault = find_fault(path);
  if (fault.empty()) {
    try {
      file.bag->open(path, rosbag::bagmode::Read);
      file.nodes = nodes_of(*file.bag);
    } catch (const std::exception& error) {
      fault = error.what() + ("; if it was not closed or is damaged, `rosbag reindex " + path) +
              "` recovers what is in it (take a copy while it is written)";
    }
  }
  if (!fault.empty()) throw Problem(path + ": " + fault);
  return file;
}

void add_topic(const rosbag::ConnectionInfo& connection, const std::string& path, Recording::Topics& topics) {
  const auto known = kTypes.find(connection.datatype);
  if (known == kTypes.end()) return;
  if (connection.md5sum != known->second) {
    throw Problem(path + ": " + connection.topic + " is of another version of " + connection.datatype);
  }
  const auto [topic, is_new] = topics.emplace(connection.datatype, connection.topic);
  if (is_new || topic->second == connection.topic) return;
  throw Problem(path + ": " + topic->second + " and " + connection.topic + " are both of the type " +
                connection.datatype + " and both by the node \"" + callerid(connection) +
                "\", such as rosbag play: of several emulators, and nothing says which topics are of the same one");
}

// The emulators of a bag, by the names of their nodes.
std::map<std::string, Recording::Topics> emulators_of(const File& file) {
  std::map<std::string, Recording::Topics> found;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(*file.bag).getConnections()) {
    if (kTypes.count(connection->datatype) > 0) add_topic(*connection, file.path, found[file.nodes.at(connection->id)]);
  }
  return found;
}

std_msgs::Header header_of(const rosbag::MessageInstance& message) {
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  ros::serialization::IStream in(bytes.data(), message.size());
  std_msgs::Header header;  // every message begins with it
  ros::serialization::deserialize(in, header);
  return header;
}

// Whether the node named it as a part of the recording that begins with NAME.bag: NAME_001.bag, NAME_002.bag.
bool is_part(const std::string& path, const std::string& first) {
  const std::string part = std::filesystem::canonical(path), whole = std::filesystem::canonical(first);
  const std::string name = whole.substr(0, whole.rfind(".bag"));
  return part.compare(0, name.size(), name) == 0 &&
         std::regex_match(part.substr(name.size()), std::regex("_[0-9]{3,}\\.bag(\\.active)?"));
}

// False where the node published more between them, without a batch: as at a reset after a recording was stopped. The
// parts of rosbag record may lack a message.
template <class Message>
bool may_go_on(const Recording& before, const Recording& after) {
  const std::string topic = after.topic<Message>();
  const auto end = before.ends_of(topic).last, begin = after.ends_of(topic).first;
  return !begin || !end || header_of(*begin).seq <= header_of(*end).seq + 1;
}

// One that both hold with a message of each batch, whose numbers show what lies between; or none.
std::string topic_of_batches(const Recording& before, const Recording& after) {
  for (const auto& [mine, others] :
       {std::pair(before.topic<afm_emulator::Friction>(), after.topic<afm_emulator::Friction>()),
        {before.topic<afm_emulator::Deflection>(), after.topic<afm_emulator::Deflection>()},
        {before.topic<afm_emulator::ImpactArray>(), after.topic<afm_emulator::ImpactArray>()}}) {
    if (mine == others && !mine.empty()) return mine;
  }
  return {};
}

// How many batches are missing between two parts of one recording; nothing if they are not.
std::optional<std::uint32_t> batches_between(const Recording& before, const Recording& after) {
  const std::string topic = topic_of_batches(before, after);
  if (topic.empty()) return std::nullopt;
  const auto begin = after.ends_of(topic).first;
  const auto end = Recording(before.node(), {}, {before.files().back()}).ends_of(topic).last;
  if (!begin || !end) return std::nullopt;
  const std::uint32_t first = header_of(*begin).seq, last = header_of(*end).seq;
  const bool is_named_so = is_part(after.files().front().path, before.files().front().path);
  const bool follows =
      first == last + 1 &&
      (is_named_so || !after.is_by_node() ||
       (may_go_on<afm_emulator::Snapshot>(before, after) && may_go_on<afm_emulator::Applied>(before, after)));
  if (!follows && (first <= last || !is_named_so)) return std::nullopt;
  return first - last - 1;
}

// About how many whole batches, or batches like this one, lie between two model times; at least one, unless there is no
// time between.
std::uint64_t batches_within(const afm_emulator::ModelTime& from, const afm_emulator::ModelTime& to,
                             const afm_emulator::Friction& batch, const afm_emulator::Applied* applied) {
  const auto tau = [](const afm_emulator::ModelTime& a, const afm_emulator::ModelTime& b) {
    return (static_cast<double>(b.tau) - static_cast<double>(a.tau)) + (b.phase - a.phase);  // damaged: any number
  };
  const double whole =
      applied == nullptr ? 0.0 : static_cast<double>(applied->samples_per_batch) * applied->sample_period_tau;
  const double time = tau(from, to), length = std::max(tau(batch.begin, batch.time), whole);
  if (!(time > 0.0)) return 0;
  return length > 0.0 && time < kMostTold * length ? std::max(1LL, std::llround(time / length)) : 1;
}

std::string known_names(const std::map<std::string, std::vector<Recording>>& recordings) {
  std::string names;
  for (const auto& [node, unused] : recordings) names += (names.empty() ? "" : ", ") + node;
  return names;
}

}  // namespace

std::string Recording::name() const {
  std::string name = node_ + " in " + files_.front().path;
  if (files_.size() > 1) name += " and the " + std::to_string(files_.size() - 1) + " that follow it";
  return name + holes_;
}

void Recording::add(const Recording& next, std::uint32_t batches_between) {
  if (batches_between > 0) {
    holes_ += "; " + next.files_.front().path + " does not go on where " + files_.back().path +
              " ends: " + std::to_string(batches_between) + " batches between are missing";
  }
  topics_.insert(next.topics_.begin(), next.topics_.end());
  files_.insert(files_.end(), next.files_.begin(), next.files_.end());
}

std::unique_ptr<rosbag::View> Recording::view(const std::string& topic, const ros::Time& begin,
                                              const ros::Time& end) const {
  auto view = std::make_unique<rosbag::View>();
  for (const File& file : files_) {
    view->addQuery(
        *file.bag,
        [topic, node = node_, nodes = file.nodes](const rosbag::ConnectionInfo* connection) {
          return connection->topic == topic && nodes.at(connection->id) == node &&
                 kTypes.count(connection->datatype) > 0;
        },
        begin, end);
  }
  return view;
}

// From the topics that have few messages: in each, a start is where the number is 0, or lower than the one before.
std::shared_ptr<const Starts> Recording::starts() const {
  if (starts_) return starts_;
  Starts starts;
  for (const std::string& topic :
       {topic<afm_emulator::Configuration>(), topic<afm_emulator::Applied>(), topic<afm_emulator::Snapshot>()}) {
    const auto messages = view(topic);
    std::optional<std_msgs::Header> last;
    for (const rosbag::MessageInstance& message : *messages) {
      const std_msgs::Header header = header_of(message);
      if (header.stamp > message.getTime() + ros::Duration(1.0)) starts.set_back();  // a latched one
      if (is_simulated(header.stamp) || (last && header.stamp <= last->stamp)) continue;
      const bool again = last && header.seq <= last->seq;
      if (header.seq == 0 || again) starts.add(last ? last->stamp : ros::TIME_MIN, header.stamp);
      last = header;
    }
  }
  // in a part that the node began after the clock was set back, whose stamps in the bag go on
  const auto configuration = ends_of(topic<afm_emulator::Configuration>()).first;
  const auto snapshot = ends_of(topic<afm_emulator::Snapshot>()).first;
  if (configuration && snapshot && header_of(*configuration).stamp > header_of(*snapshot).stamp + ros::Duration(1.0)) {
    starts.set_back();
  }
  starts.merge();
  return starts_ = std::make_shared<const Starts>(std::move(starts));
}

Recording::Ends Recording::ends_of(const std::string& topic) const {
  const auto all = view(topic);
  if (all->size() == 0) return {};
  Ends ends{*all->begin(), {}};
  const auto end = view(topic, all->getEndTime());
  for (const rosbag::MessageInstance& message : *end) ends.last.emplace(message);
  return ends;
}

// The node alone writes a configuration and a command two nanoseconds and one before the snapshot with which a
// recording begins.
bool Recording::is_by_node() const {
  const auto snapshots = view(topic<afm_emulator::Snapshot>());
  const auto is_before_it = [&](const std::string& topic, int nanoseconds) {
    const auto messages = view(topic);
    return messages->size() > 0 && snapshots->size() > 0 &&
           messages->getBeginTime() + ros::Duration(0, nanoseconds) == snapshots->getBeginTime();
  };
  return is_before_it(topic<afm_emulator::Configuration>(), 2) || is_before_it(topic<afm_emulator::Applied>(), 1);
}

std::uint64_t Recording::commands_missing_at_beginning() const {
  const auto applied = view(topic<afm_emulator::Applied>());
  const bool is_missing = is_by_node() && applied->size() > 0 &&
                          applied->getBeginTime() > view(topic<afm_emulator::Snapshot>())->getBeginTime();
  return is_missing ? 1 : 0;
}

// With one start the ends of the topic; else every stamp has to be read.
const Recording::EndsOfStarts& Recording::ends_by_start(const std::string& topic) const {
  const auto [known, is_new] = ends_.try_emplace(topic);
  EndsOfStarts& found = known->second;
  if (!is_new) return found;
  if (!has_several_starts()) {
    const Ends ends = ends_of(topic);
    if (ends.first) found.emplace(0, ends);
    return found;
  }
  const auto messages = view(topic);
  for (const rosbag::MessageInstance& message : *messages) {
    const auto [ends, is_first] = found.emplace(starts()->of(header_of(message).stamp), Ends{message, {}});
    ends->second.last.emplace(message);
  }
  return found;
}

template <class Message>
boost::shared_ptr<Message> Recording::first(std::uint64_t start) const {
  const EndsOfStarts& ends = ends_by_start(topic<Message>());
  const auto found = ends.find(start);
  return found == ends.end() ? nullptr : found->second.first->instantiate<Message>();
}

template <class Message>
boost::shared_ptr<Message> Recording::last(std::uint64_t start) const {
  const EndsOfStarts& ends = ends_by_start(topic<Message>());
  const auto found = ends.find(start);
  return found == ends.end() ? nullptr : found->second.last->instantiate<Message>();
}

// A recording by the node begins with the snapshot before its first batch.
std::uint64_t Recording::batches_proved_at_beginning(std::uint64_t start) const {
  if (!is_by_node()) return 0;
  const auto batch = first<afm_emulator::Friction>(start);
  const auto snapshot = first<afm_emulator::Snapshot>(start);
  if (!batch || !snapshot || batch->epoch != snapshot->epoch) return 0;
  return batches_within(snapshot->time, batch->begin, *batch, &snapshot->applied);
}

// The node publishes a status, a command and a snapshot after the batch up to which they tell.
std::uint64_t Recording::batches_proved_at_end(std::uint64_t start) const {
  const auto batch = last<afm_emulator::Friction>(start);
  if (!batch) return 0;
  std::uint64_t most = 0;
  const auto applied = last<afm_emulator::Applied>(start);
  const auto hear = [&](const auto& message) {
    if (!message || message->epoch < batch->epoch) return;
    const bool is_reset = message->epoch > batch->epoch;
    most = std::max(
        most, batches_within(is_reset ? afm_emulator::ModelTime() : batch->time, message->time, *batch, applied.get()));
  };
  hear(last<afm_emulator::EmulatorStatus>(start));
  hear(applied);
  hear(last<afm_emulator::Snapshot>(start));
  return most;
}

bool Recording::is_cut() const {
  ros::Time batch = ros::TIME_MIN, other = ros::TIME_MIN;
  for (const auto& [type, topic] : topics_) {
    ros::Time& latest = kBatchTypes.count(type) > 0 ? batch : other;
    latest = std::max(latest, view(topic)->getEndTime());
  }
  return other <= batch;
}

// The three messages of a batch have one number. The node records whole batches, but for the last one where it is
// killed; then nothing stands behind it. `rosbag record` subscribes to topic after topic, and leaves what waits in
// their queues at its end.
void Recording::add_missing(const std::string& type, std::uint64_t start, Missing& missing) const {
  std::optional<std::pair<std::uint32_t, std::uint32_t>> own, friction, all;
  for (const auto& [name, topic] : topics_) {
    if (kBatchTypes.count(name) == 0) continue;
    const EndsOfStarts& ends = ends_by_start(topic);
    const auto found = ends.find(start);
    if (found == ends.end()) continue;
    const auto numbers = std::make_pair(header_of(*found->second.first).seq, header_of(*found->second.last).seq);
    if (name == type) own = numbers;
    if (name == ros::message_traits::datatype<afm_emulator::Friction>()) friction = numbers;
    if (!all) all = numbers;
    all = {std::min(all->first, numbers.first), std::max(all->second, numbers.second)};
  }
  if (!own) {
    missing.at_beginning += all->second - all->first + 1;
    return;
  }
  const bool exact = is_by_node();
  const auto add = [&](std::uint64_t lacking, std::uint64_t allowed, std::uint64_t& end) {
    (lacking > allowed ? end : missing.tolerated) += lacking;
  };
  add(own->first - all->first, exact ? 0 : node::kBatchQueueSize, missing.at_beginning);
  add(all->second - own->second, !exact ? node::kBatchQueueSize : is_cut() ? 1 : 0, missing.at_end);
  if (!friction) return;
  const std::uint64_t held_before = friction->first - all->first, held_after = all->second - friction->second;
  missing.at_beginning += std::max(batches_proved_at_beginning(start), held_before) - held_before;
  add(std::max(batches_proved_at_end(start), held_after) - held_after, exact ? 0 : node::kBatchQueueSize,
      missing.at_end);
}

Recording::Missing Recording::missing_at_ends(const std::string& type) const {
  Missing missing;
  if (kBatchTypes.count(type) == 0 || topics_.count(type) == 0) return missing;
  std::set<std::uint64_t> starts;
  for (const auto& [name, topic] : topics_) {
    if (kBatchTypes.count(name) == 0) continue;
    for (const auto& [start, unused] : ends_by_start(topic)) starts.insert(start);
  }
  for (const std::uint64_t start : starts) add_missing(type, start, missing);
  return missing;
}

std::vector<Recording> open_recordings(const std::vector<std::string>& paths, const std::string& node) {
  std::map<std::string, std::vector<Recording>> found;
  std::vector<File> files;
  require_files_for(paths.size());
  for (const std::string& path : paths) files.push_back(open(path));
  // a shell may list the parts of a recording in another order
  const auto begin = [](const File& file) {
    rosbag::View batches(*file.bag, rosbag::TypeQuery("afm_emulator/Friction"));
    return batches.size() > 0 ? batches.getBeginTime() : rosbag::View(*file.bag).getBeginTime();
  };
  std::stable_sort(files.begin(), files.end(), [&](const File& a, const File& b) { return begin(a) < begin(b); });
  std::vector<std::string> empty;  // such as of rosbag record before the emulator began
  for (const File& file : files) {
    const auto emulators = emulators_of(file);
    if (emulators.empty()) empty.push_back(file.path + ": holds no message of an emulator");
    for (const auto& [name, topics] : emulators) {
      std::vector<Recording>& recordings = found[name];
      const Recording part(name, topics, {file});
      const auto between = recordings.empty() ? std::nullopt : batches_between(recordings.back(), part);
      if (between) {
        recordings.back().add(part, *between);
      } else {
        recordings.push_back(part);
      }
    }
  }
  if (found.empty()) throw Problem(empty.front());
  for (const std::string& note : empty) std::cerr << note << std::endl;
  if (!node.empty() && found.count(node) == 0) {
    throw Problem("node = " + node + ": there is none of this name, but " + known_names(found));
  }
  std::vector<Recording> chosen;
  for (const auto& [name, recordings] : found) {
    if (node.empty() || node == name) chosen.insert(chosen.end(), recordings.begin(), recordings.end());
  }
  return chosen;
}

}  // namespace afm::bags
