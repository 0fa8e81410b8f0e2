// One recording: a bag, or the bags it was split into, opened for reading; its topics found by their types.
#pragma once

#include <afm_emulator/Recording.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "verdict.h"

namespace afm::replay {

struct RecordedBag {
  std::string path;
  rosbag::Bag bag;
  std::vector<afm_emulator::Recording> marks;
  std::uint64_t messages = 0;  // of our topics, without marks
};

class Recording {
 public:
  // node: the namespace of the emulator such as /afm; empty: the only one there is. Throws Problem.
  Recording(std::unique_ptr<RecordedBag> first, const std::string& node);

  // Whether the bag was written where the last one of ours ended; if so it is taken over. Throws Problem if it is
  // another part of the same recording.
  bool append(std::unique_ptr<RecordedBag>& bag);

  const std::vector<std::unique_ptr<RecordedBag>>& bags() const { return bags_; }
  const std::string& node() const { return node_; }
  std::string topic(const std::string& name) const { return node_ + "/" + name; }
  std::string name() const;  // the bags, for people

  bool is_closed() const;     // by the recorder itself, or goes on in another bag
  bool is_continued() const;  // goes on in a bag that is not ours

 private:
  void check_types(const RecordedBag& bag) const;
  void check_marks(const RecordedBag& bag) const;
  void add(std::unique_ptr<RecordedBag> bag);

  std::string node_;
  std::vector<std::unique_ptr<RecordedBag>> bags_;
};

// Throws Problem: what is not a bag, has no index, is damaged.
std::unique_ptr<RecordedBag> open_bag(const std::string& path);

// The arguments as recordings: parts of one follow each other.
std::list<Recording> open_recordings(const std::vector<std::string>& paths, const std::string& node);

}  // namespace afm::replay
