#include "recording.h"

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/Snapshot.h>

namespace afm::bags {
namespace {

using File = Recording::File;

template <class... Messages>
std::map<std::string, std::string> md5sums() {
  return {{ros::message_traits::datatype<Messages>(), ros::message_traits::md5sum<Messages>()}...};
}

// The types that are read here, and the definitions that this program has of them.
const std::map<std::string, std::string> kTypes =
    md5sums<afm_emulator::Applied, afm_emulator::Configuration, afm_emulator::Deflection, afm_emulator::Friction,
            afm_emulator::ImpactArray, afm_emulator::Snapshot>();

File open(const std::string& path) {
  const File file{path, std::make_shared<rosbag::Bag>()};
  try {
    file.bag->open(path, rosbag::bagmode::Read);
  } catch (const std::exception& error) {
    throw Problem(path + ": " + error.what() + "; if it is a bag that was not closed or is damaged, `rosbag reindex " +
                  path + "` recovers what is in it");
  }
  return file;
}

std::string callerid(const rosbag::ConnectionInfo& connection) {
  if (!connection.header) return "";
  const auto found = connection.header->find("callerid");
  return found == connection.header->end() ? "" : found->second;
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
                "\", such as rosbag play: of several emulators, and nothing tells which topics are of the same one");
}

// The emulators of a bag, by the names of their nodes.
std::map<std::string, Recording::Topics> emulators_of(const File& file) {
  std::map<std::string, Recording::Topics> found;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(*file.bag).getConnections()) {
    if (kTypes.count(connection->datatype) > 0) add_topic(*connection, file.path, found[callerid(*connection)]);
  }
  return found;
}

// The first and the last batch of one bag.
std::pair<std::uint32_t, std::uint32_t> ends_of(const Recording& part) {
  const std::string topic = part.topic<afm_emulator::Friction>();
  const auto all = part.view(topic), end = part.view(topic, all->getEndTime());
  const auto seq = [](const rosbag::MessageInstance& m) { return m.instantiate<afm_emulator::Friction>()->header.seq; };
  std::uint32_t last = seq(*all->begin());
  const std::uint32_t first = last;
  for (const rosbag::MessageInstance& message : *end) last = seq(message);
  return {first, last};
}

bool follows(const Recording& before, const Recording& after) {
  const std::string topic = before.topic<afm_emulator::Friction>();
  if (topic.empty() || topic != after.topic<afm_emulator::Friction>()) return false;
  const Recording last(before.node(), {{ros::message_traits::datatype<afm_emulator::Friction>(), topic}},
                       {before.files().back()});
  return ends_of(after).first == ends_of(last).second + 1;
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
  return name;
}

void Recording::add(const Recording& next) {
  topics_.insert(next.topics_.begin(), next.topics_.end());
  files_.insert(files_.end(), next.files_.begin(), next.files_.end());
}

std::unique_ptr<rosbag::View> Recording::view(const std::string& topic, const ros::Time& begin) const {
  auto view = std::make_unique<rosbag::View>();
  for (const File& file : files_) {
    view->addQuery(*file.bag,
                   [topic, node = node_](const rosbag::ConnectionInfo* connection) {
                     return connection->topic == topic && callerid(*connection) == node &&
                            kTypes.count(connection->datatype) > 0;
                   },
                   begin);
  }
  return view;
}

std::vector<Recording> open_recordings(const std::vector<std::string>& paths, const std::string& node) {
  std::map<std::string, std::vector<Recording>> found;
  for (const std::string& path : paths) {
    const File file = open(path);
    for (const auto& [name, topics] : emulators_of(file)) {
      std::vector<Recording>& recordings = found[name];
      const Recording part(name, topics, {file});
      if (!recordings.empty() && follows(recordings.back(), part)) {
        recordings.back().add(part);
      } else {
        recordings.push_back(part);
      }
    }
  }
  if (found.empty()) throw Problem(paths.front() + ": holds no message of an emulator");
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
