#include "recorder.h"

#include <ros/console.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "bag_name.h"
#include "node/stepping/scheduling.h"

namespace afm::node {
namespace {

// Eight seconds at 1 MHz of samples: longer than a disk stalls to flush its caches.
constexpr std::size_t kMaxQueueBytes = 128 * 1024 * 1024;
constexpr std::chrono::seconds kCloseDeadline{30};

bool is_taken(const std::filesystem::path& path) {
  return exists(path) || std::filesystem::exists(path.string() + ".active");
}

// The first name from the time that is not taken.
std::string free_name(const std::filesystem::path& directory) {
  const std::string base = name_from_time(std::time(nullptr));
  for (int i = 0;; ++i) {
    const std::string name = i == 0 ? base : base + "-" + std::to_string(i);
    if (!is_taken(directory / with_bag_ending(name))) return name;
  }
}

}  // namespace

Recorder::Recorder(const Settings& settings) : settings_(settings), thread_([this] { write_loop(); }) {}

Recorder::~Recorder() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = quitting_ = true;
  }
  work_.notify_all();
  thread_.join();
}

std::unique_ptr<BagSeries> Recorder::open(const std::string& name) const {
  const std::string fault = name.empty() ? "" : find_name_fault(name);
  if (!fault.empty()) throw std::runtime_error("name = \"" + name + "\": " + fault);
  const std::filesystem::path directory = std::filesystem::absolute(expand_home(settings_.directory));
  std::filesystem::create_directories(directory);
  const std::string chosen = name.empty() ? free_name(directory) : name;
  return std::make_unique<BagSeries>(settings_.bags, directory.string(), chosen);
}

Recorder::Reply Recorder::start(const std::string& name) {
  const std::lock_guard<std::mutex> one_at_a_time(starting_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bags_) return {false, "already recording " + path_, path_};
  }
  try {
    auto bags = open(name);
    const std::lock_guard<std::mutex> lock(mutex_);
    bags_ = std::move(bags);
    path_ = bags_->path();
    error_.clear();
    dropped_before_ = dropped_messages_;
    enqueue_history();
    ROS_INFO_STREAM("recording " << path_);
    return {true, "recording " + path_, path_};
  } catch (const std::exception& error) {
    return {false, error.what(), ""};
  }
}

Recorder::Reply Recorder::stop() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!bags_) return {false, error_.empty() ? "not recording" : "not recording any more: " + error_, ""};
  stopping_ = true;
  work_.notify_all();
  if (!closed_.wait_for(lock, kCloseDeadline, [this] { return !bags_; })) {
    return {false, path_ + " is still being written to a slow disk", path_};
  }
  if (!error_.empty()) return {false, error_, path_};
  return {true, path_ + ": " + std::to_string(last_messages_) + " messages", path_};
}

Recorder::Status Recorder::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {bags_ ? path_ : "", error_, dropped_messages_, dropped_messages_ - dropped_before_};
}

void Recorder::enqueue_history() {
  if (!history_.configuration()) return;  // nothing has happened yet
  enqueue(settings_.bags.topics.configuration, history_.configuration());
  if (history_.checkpoint()) enqueue(settings_.bags.topics.checkpoint, history_.checkpoint());
  for (const auto& command : history_.commands()) enqueue(settings_.bags.topics.applied_drag, command);
  for (const auto& change : history_.changes()) enqueue(settings_.bags.topics.applied_parameters, change);
}

// In the order of arrival even if the wall clock is set back, and no two alike, as readers of bags sort by this.
ros::Time Recorder::next_stamp() {
  const ros::WallTime now = ros::WallTime::now();
  last_stamp_ = std::max(last_stamp_ + ros::Duration(0, 1), ros::Time(now.sec, now.nsec));
  return last_stamp_;
}

void Recorder::push(Item item) {
  if (queue_bytes_ + item.bytes > kMaxQueueBytes) {
    ++dropped_messages_;
    return;
  }
  queue_bytes_ += item.bytes;
  queue_.push_back(std::move(item));
  work_.notify_one();
}

void Recorder::write_loop() {
  std::unique_lock<std::mutex> lock(mutex_);
  name_thread("afm_record");
  while (bags_ || !quitting_) {
    work_.wait(lock, [this] { return !queue_.empty() || stopping_; });
    if (queue_.empty()) {
      finish(lock, {});
      continue;
    }
    const Item item = std::move(queue_.front());
    queue_.pop_front();
    queue_bytes_ -= item.bytes;
    bags_->set_dropped(dropped_messages_ - dropped_before_);
    lock.unlock();
    std::string error = write(item);
    lock.lock();
    path_ = bags_->path();
    if (!error.empty()) finish(lock, std::move(error));
  }
}

std::string Recorder::write(const Item& item) {
  const std::string trouble = bags_->find_trouble(item.bytes);
  if (!trouble.empty()) return "stopped: " + trouble;
  try {
    item.write(*bags_);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void Recorder::finish(std::unique_lock<std::mutex>& lock, std::string error) {
  stopping_ = true;  // nothing more is queued while we close
  queue_.clear();
  queue_bytes_ = 0;
  if (bags_) {
    bags_->set_dropped(dropped_messages_ - dropped_before_);
    lock.unlock();
    const std::string close_error = bags_->close();
    lock.lock();
    if (!close_error.empty()) error += (error.empty() ? "" : "; ") + close_error;
    if (!error.empty()) error = bags_->path() + ": " + error;
    last_messages_ = bags_->messages();
    bags_.reset();
    if (error.empty()) {
      ROS_INFO_STREAM("recorded " << path_ << ": " << last_messages_ << " messages");
    } else {
      ROS_ERROR_STREAM("recording ended early: " << error);
    }
  }
  error_ = std::move(error);
  stopping_ = quitting_;
  closed_.notify_all();
}

}  // namespace afm::node
