#include "recording.h"

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Digest.h>
#include <afm_emulator/EmulatorStatus.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "bag_end.h"
#include "message_stream.h"
#include "node/wire/topics.h"

namespace afm::replay {
namespace {

const std::string kMagic = "#ROSBAG V2.0\n";

template <class Message>
void add_md5sum(std::map<std::string, std::string>& sums) {
  sums[ros::message_traits::datatype<Message>()] = ros::message_traits::md5sum<Message>();
}

// Those of the messages a check reads, by type.
std::map<std::string, std::string> expected_md5sums() {
  std::map<std::string, std::string> sums;
  add_md5sum<afm_emulator::Configuration>(sums);
  add_md5sum<afm_emulator::Checkpoint>(sums);
  add_md5sum<afm_emulator::AppliedDrag>(sums);
  add_md5sum<afm_emulator::AppliedParameters>(sums);
  add_md5sum<afm_emulator::Deflection>(sums);
  add_md5sum<afm_emulator::ImpactArray>(sums);
  add_md5sum<afm_emulator::Friction>(sums);
  add_md5sum<afm_emulator::Digest>(sums);
  add_md5sum<afm_emulator::EmulatorStatus>(sums);
  add_md5sum<afm_emulator::Recording>(sums);
  return sums;
}

void check_magic(const std::string& path) {
  const auto refuse = [&](const std::string& why) { throw Problem(Verdict::foreign, path + ": " + why); };
  if (std::filesystem::is_directory(path)) refuse("is a directory: give the bags in it");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse("cannot be opened");
  if (file.peek() == std::ifstream::traits_type::eof()) refuse("is empty");
  std::string head(kMagic.size(), '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!file || head != kMagic) refuse("is not a ROS bag (version 2.0)");
}

std::string find_node(const rosbag::Bag& bag, const std::string& path) {
  const std::string ending = std::string("/") + node::kConfigurationTopic;
  std::set<std::string> nodes;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const std::string& topic = connection->topic;
    if (connection->datatype != ros::message_traits::datatype<afm_emulator::Configuration>() || topic.size() < ending.size()) continue;
    if (topic.substr(topic.size() - ending.size()) == ending)
      nodes.insert(topic.substr(0, topic.size() - ending.size()));
  }
  if (nodes.empty())
    throw Problem(Verdict::foreign, path + ": holds no configuration of an emulator: not its recording");
  if (nodes.size() == 1) return *nodes.begin();
  std::string names;
  for (const std::string& name : nodes) names += " " + name;
  throw Problem(Verdict::usage, path + ": holds several emulators, choose one with --node:" + names);
}

// Of two bags of one split recording.
void check_follows(const afm_emulator::Recording& last, const afm_emulator::Recording& first, const std::string& path) {
  if (first.part == last.part + 1) return;
  const std::string found = path + ": is part " + std::to_string(first.part) + " of " + last.name;
  if (first.part <= last.part) {
    throw Problem(Verdict::reordered, found + ", given after part " + std::to_string(last.part));
  }
  throw Problem(Verdict::missing, found + ", and part " + std::to_string(last.part + 1) + " is missing");
}

}  // namespace

std::unique_ptr<RecordedBag> open_bag(const std::string& path) {
  check_magic(path);
  auto opened = std::make_unique<RecordedBag>();
  opened->path = path;
  try {
    opened->bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw Problem(Verdict::truncated,
                  path + ": has no index: it was never closed; rosbag reindex '" + path + "' recovers what is in it");
  } catch (const std::exception& error) {
    throw Problem(Verdict::truncated, path + ": is damaged or cut off (" + error.what() + "); rosbag reindex '" + path +
                                          "' recovers what is left");
  }
  const std::uint64_t behind = bytes_behind(path);
  if (behind == 0) return opened;
  throw Problem(Verdict::altered,
                path + ": has " + std::to_string(behind) +
                    " bytes behind its end, as when bags are joined into one file; nobody would read them");
}

Recording::Recording(std::unique_ptr<RecordedBag> first, const std::string& node)
    : node_(node.empty() ? find_node(first->bag, first->path) : node) {
  add(std::move(first));
}

void Recording::add(std::unique_ptr<RecordedBag> bag) {
  check_types(*bag);
  MessageStream<afm_emulator::Recording> marks(topic(node::kRecordingTopic));
  marks.add(bag->bag, bag->path);
  for (; marks.head() != nullptr; marks.pop()) bag->marks.push_back(*marks.head());
  check_marks(*bag);
  bags_.push_back(std::move(bag));
}

void Recording::check_types(const RecordedBag& bag) const {
  const auto expected = expected_md5sums();
  rosbag::View view(bag.bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto type = expected.find(connection->datatype);
    if (type == expected.end() || type->second == connection->md5sum) continue;
    throw Problem(Verdict::foreign, bag.path + ": " + connection->topic + " has another definition of " + type->first +
                                        ": recorded by another version of the emulator");
  }
}

// The last mark says how many messages came before it.
void Recording::check_marks(const RecordedBag& bag) const {
  if (bag.marks.empty() || bag.marks.back().kind == afm_emulator::Recording::BEGUN) return;
  rosbag::View view(bag.bag, [this](const rosbag::ConnectionInfo* connection) {
    return connection->topic.compare(0, node_.size() + 1, node_ + "/") == 0;
  });
  const std::uint64_t found = view.size() - 1, expected = bag.marks.back().messages;
  if (found < expected) {
    throw Problem(Verdict::missing, bag.path + ": was closed with " + std::to_string(expected) +
                                        " messages, and holds " + std::to_string(found));
  }
  if (found > expected) {
    throw Problem(Verdict::altered, bag.path + ": was closed with " + std::to_string(expected) +
                                        " messages, and now holds " + std::to_string(found));
  }
}

bool Recording::append(std::unique_ptr<RecordedBag>& bag) {
  if (!is_continued()) return false;
  const afm_emulator::Recording last = bags_.back()->marks.back();
  MessageStream<afm_emulator::Recording> marks(topic(node::kRecordingTopic));
  marks.add(bag->bag, bag->path);
  const auto* first = marks.head();
  if (first == nullptr || first->part == 0 || first->name != last.name) return false;
  check_follows(last, *first, bag->path);
  add(std::move(bag));
  return true;
}

std::string Recording::name() const {
  const std::string& first = bags_.front()->path;
  return bags_.size() == 1 ? first : first + " ... " + bags_.back()->path;
}

bool Recording::is_closed() const {
  const auto& marks = bags_.back()->marks;
  return !marks.empty() && marks.back().kind != afm_emulator::Recording::BEGUN;
}

bool Recording::is_continued() const {
  const auto& marks = bags_.back()->marks;
  return !marks.empty() && marks.back().kind == afm_emulator::Recording::CONTINUED;
}

std::list<Recording> open_recordings(const std::vector<std::string>& paths, const std::string& node) {
  std::list<Recording> recordings;
  for (const std::string& path : paths) {
    auto bag = open_bag(path);
    if (!recordings.empty() && recordings.back().append(bag)) continue;
    recordings.emplace_back(std::move(bag), node);
  }
  return recordings;
}

}  // namespace afm::replay
