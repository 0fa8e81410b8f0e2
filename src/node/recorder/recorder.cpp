#include "recorder.h"

#include <pthread.h>
#include <ros/console.h>
#include <ros/this_node.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <regex>
#include <utility>

namespace afm::node {
namespace {

namespace fs = std::filesystem;

// 134 MB: 7.7 s at 1 MHz of samples (docs/data/recording_cost.csv), longer than a disk stalls to flush its caches.
constexpr std::size_t kMaxQueueBytes = 128 * 1024 * 1024;
constexpr std::chrono::seconds kCloseDeadline{30};
constexpr std::chrono::seconds kBatchDeadline{5};  // a disk may hold it up, or a subscriber twice for a second
// Messages: a batch has three, and ten seconds of a pause have as many as this. Commands do not count: many may come
// within a batch.
constexpr std::size_t kMostHeld = 100;

// The fault of a name that a user asks for, or nothing. A good one stays in its directory.
std::string find_name_fault(const std::string& name) {
  constexpr std::size_t kMaxLength = 200;  // file systems take 255 bytes, and endings are added
  static const std::regex good("[A-Za-z0-9]([A-Za-z0-9_.+-]*[A-Za-z0-9])?");
  if (name.find('/') != std::string::npos) return "must not contain a path: bags are written to bag_directory";
  if (name.size() > kMaxLength) return "must have at most " + std::to_string(kMaxLength) + " characters";
  if (std::regex_match(name, good)) return {};
  return "must be of letters, digits and _ . + - only, and begin and end with a letter or digit";
}

// The file or link in the way of a bag, of a recording that is closed or under way; or nothing.
std::string taken_by(const std::string& bag) {
  for (const std::string& path : {bag, bag + ".active"}) {
    if (fs::exists(fs::symlink_status(path))) return path;
  }
  return {};
}

// directory/NAME without .bag; of an empty name that of the node with the local time, afm_2024-05-31-12-00-00, or what
// follows if that is taken. Two nodes may begin in the same moment.
std::string bag_base(const std::string& directory, const std::string& name) {
  const fs::path place = fs::absolute(directory);
  if (!name.empty()) return place / std::regex_replace(name, std::regex("\\.bag$"), "");
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  std::strftime(text, sizeof text, "_%Y-%m-%d-%H-%M-%S", &local);
  std::string node = ros::this_node::getName();
  node.erase(0, node.find_first_not_of('/'));
  std::replace(node.begin(), node.end(), '/', '_');
  const std::string base = place / (node + text);
  std::string free = base;
  for (int i = 1; !taken_by(free + ".bag").empty(); ++i) free = base + "-" + std::to_string(i);
  return free;
}

}  // namespace

Recorder::Recorder(const Settings& settings, std::function<bool()> ask_for_snapshot)
    : settings_(settings), ask_for_snapshot_(std::move(ask_for_snapshot)), thread_([this] { write_loop(); }) {}

Recorder::~Recorder() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = quitting_ = true;
  }
  work_.notify_all();
  thread_.join();
}

// NAME, NAME_001, NAME_002: a shell lists NAME*.bag in this order.
std::string Recorder::part_path(std::uint32_t part) const {
  char number[16] = "";
  if (part > 0) std::snprintf(number, sizeof number, "_%03u", part);
  return base_ + number + ".bag";
}

// Of a recording that splits: it would end there.
std::string Recorder::taken_part() const {
  constexpr std::uint32_t kParts = 1000;  // a choice: what is left of an older recording has the first numbers
  std::string taken;
  for (std::uint32_t part = 1; splits() && taken.empty() && part < kParts; ++part) taken = taken_by(part_path(part));
  return taken;
}

Recorder::Reply Recorder::start(const std::string& name) {
  const std::lock_guard<std::mutex> one_at_a_time(orders_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bag_) return {false, "already recording " + path_, path_};
  }
  const std::string fault = name.empty() ? "" : find_name_fault(name);
  if (!fault.empty()) return {false, "name = \"" + name + "\": " + fault, ""};
  try {
    std::filesystem::create_directories(std::filesystem::absolute(settings_.directory));
    base_ = bag_base(settings_.directory, name);
    const std::string taken = taken_part();
    if (!taken.empty()) return {false, taken + ": there is such a bag already, and the recording would split", ""};
    auto bag = std::make_unique<BagFile>(part_path(0), settings_.reserve_bytes, settings_.compression);
    const std::lock_guard<std::mutex> lock(mutex_);
    bag_ = std::move(bag);
    path_ = bag_->path();
    error_.clear();
    last_stamp_ = {};
    messages_ = 0;
    part_ = 0;
    full_ = begun_ = false;
    dropped_before_ = dropped_messages_;
  } catch (const std::exception& error) {
    return {false, error.what(), ""};
  }
  ROS_INFO_STREAM("recording " << path_);
  return {true, "recording " + path_, path_};
}

Recorder::Reply Recorder::stop() {
  const std::lock_guard<std::mutex> one_at_a_time(orders_);  // or it would wait for a recording that began meanwhile
  std::unique_lock<std::mutex> lock(mutex_);
  settled_.wait_for(lock, kBatchDeadline, [this] { return !bag_ || !is_within_batch_; });
  if (!bag_) return {false, error_.empty() ? "not recording" : "not recording any more: " + error_, ""};
  stopping_ = true;
  work_.notify_all();
  room_.notify_all();
  if (!settled_.wait_for(lock, kCloseDeadline, [this] { return !bag_; })) {
    return {false, path_ + " is still being written to a slow disk", path_};
  }
  if (!error_.empty()) return {false, error_, path_};
  return {true, summary(), messages_ == 0 ? "" : path_};
}

std::string Recorder::summary() const {
  if (messages_ == 0) return "nothing came to be recorded: there is no bag";
  std::string all = std::to_string(messages_) + " messages";
  const std::uint64_t dropped = dropped_messages_ - dropped_before_;
  if (dropped > 0) all += "; " + std::to_string(dropped) + " more are missing, as the disk was slow";
  return path_ + ": " + (part_ == 0 ? all : "the last of " + std::to_string(part_ + 1) + " bags with " + all);
}

Recorder::Status Recorder::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {bag_ ? path_ : "", error_, dropped_messages_, dropped_messages_ - dropped_before_};
}

void Recorder::record(const std::shared_ptr<const BagTopic>& topic, const ros::SerializedMessage& bytes, Role role,
                      bool unhurried) {
  std::unique_lock<std::mutex> lock(mutex_);
  const Message message{topic, bytes};
  if (role == Role::configuration) configuration_ = message;
  if (role == Role::applied) applied_ = message;
  if (role == Role::batch || role == Role::batch_end) {
    is_within_batch_ = role == Role::batch;
    settled_.notify_all();
  }
  if (!bag_ || stopping_) return;
  if (role == Role::snapshot) {
    begun_ = true;
    push(lock, {message, {}, configuration_, applied_, role}, unhurried);
  } else if (begun_) {
    push(lock, {message, {}, {}, {}, role}, unhurried);
  }
}

// A snapshot finds room in a full queue: without it no part of a recording begins.
// Stamps in the order of arrival even if the wall clock is set back, and no two alike, as readers of bags sort by them.
void Recorder::push(std::unique_lock<std::mutex>& lock, Item item, bool unhurried) {
  const std::size_t bytes = item.message.bytes.num_bytes;
  const bool is_snapshot = item.role == Role::snapshot;
  const std::size_t room = is_snapshot ? 2 * kMaxQueueBytes : kMaxQueueBytes;
  const auto has_room = [&] { return queue_.empty() || queue_bytes_ + bytes <= room; };
  if (unhurried) room_.wait(lock, [&] { return has_room() || stopping_; });
  if (!bag_ || stopping_ || !begun_) return;  // it may have ended while we waited
  if (!has_room()) {
    ++dropped_messages_;
    return;
  }
  const ros::WallTime now = ros::WallTime::now();
  last_stamp_ = std::max(last_stamp_ + ros::Duration(0, is_snapshot ? 3 : 1), ros::Time(now.sec, now.nsec));
  item.stamp = last_stamp_;
  queue_bytes_ += bytes;
  queue_.push_back(std::move(item));
  work_.notify_one();
}

void Recorder::write_loop() {
  std::unique_lock<std::mutex> lock(mutex_);
  pthread_setname_np(pthread_self(), "afm_record");
  while (bag_ || !quitting_) {
    work_.wait(lock, [this] { return !queue_.empty() || stopping_; });
    if (queue_.empty()) {
      finish(lock, {});
      continue;
    }
    const Item item = std::move(queue_.front());
    queue_.pop_front();
    queue_bytes_ -= item.message.bytes.num_bytes;
    room_.notify_one();
    lock.unlock();
    std::string error = take(item);
    lock.lock();
    path_ = bag_->path();
    if (!error.empty()) finish(lock, std::move(error));
  }
}

void Recorder::write(const Message& message, const ros::Time& stamp) {
  bag_->write(*message.topic, stamp, message.bytes);
  ++messages_;
}

// The next bag begins with the snapshot once a batch that follows it is whole: no bag has nothing that can be checked.
// Where none comes, as in a pause, what is held goes into this bag, and a later snapshot begins the next. An epoch is
// held from its first message on, as its snapshot comes behind some others.
std::string Recorder::take(const Item& item) {
  try {
    if (!full_ || (held_.empty() && item.role != Role::snapshot && item.role != Role::configuration)) {
      write(item);
    } else {
      held_.push_back(item);
      const auto snapshot =
          std::find_if(held_.begin(), held_.end(), [](const Item& i) { return i.role == Role::snapshot; });
      if (item.role == Role::batch_end && snapshot != held_.end()) {
        begin_next_bag();
        write(*snapshot);
        // of what began its epoch a status is left, and a batch of what was due at once: the rest is written already
        const auto is_written = [](const Item& i) { return i.role == Role::configuration || i.role == Role::applied; };
        held_.erase(std::remove_if(held_.begin(), snapshot, is_written), snapshot + 1);
        write_held();
      } else if (item.role != Role::applied && ++held_others_ >= kMostHeld) {
        write_held();
        full_ = ask_for_snapshot_();
      }
    }
  } catch (const std::exception& error) {
    return error.what();
  }
  if (!full_ && item.role == Role::batch_end && is_full()) full_ = ask_for_snapshot_();  // this bag has a batch, too
  return {};
}

// Throws why the recording must end.
void Recorder::write(const Item& item) {
  const std::string trouble = bag_->check_space(item.message.bytes.num_bytes);
  if (!trouble.empty()) throw std::runtime_error("stopped: " + trouble);
  if (item.role == Role::snapshot && bag_->messages() == 0) {
    begin_ = std::chrono::steady_clock::now();
    write(item.configuration, item.stamp - ros::Duration(0, 2));
    write(item.applied, item.stamp - ros::Duration(0, 1));
  }
  write(item.message, item.stamp);
}

void Recorder::write_held() {
  held_others_ = 0;
  for (const Item& item : std::exchange(held_, {})) write(item);
}

// Stamps would stand still while a wall clock that was set back catches up.
bool Recorder::is_full() const {
  const bool is_large = settings_.split_bytes > 0 && bag_->bytes() >= settings_.split_bytes;
  const double age = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  return is_large || (settings_.split_seconds > 0.0 && age >= settings_.split_seconds);
}

void Recorder::begin_next_bag() {
  auto next = std::make_unique<BagFile>(part_path(part_ + 1), settings_.reserve_bytes, settings_.compression);
  ++part_;  // only now, as that may fail: then this bag is the last
  const std::string path = bag_->path(), error = bag_->close();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    bag_ = std::move(next);
  }
  full_ = false;
  if (!error.empty()) throw std::runtime_error("the part before, " + path + ": " + error);
}

void Recorder::finish(std::unique_lock<std::mutex>& lock, std::string error) {
  stopping_ = true;  // nothing more is queued while we close
  queue_.clear();
  queue_bytes_ = 0;
  room_.notify_one();
  if (bag_) {
    lock.unlock();
    try {
      write_held();
    } catch (const std::exception& failure) {
      if (error.empty()) error = failure.what();
    }
    const std::string close_error = bag_->close();
    lock.lock();
    if (!close_error.empty()) error += (error.empty() ? "" : "; ") + close_error;
    if (!error.empty()) error = bag_->path() + ": " + error;
    bag_.reset();
    if (!error.empty()) {
      ROS_ERROR_STREAM("recording ended early: " << error);
    } else if (dropped_messages_ > dropped_before_) {
      ROS_WARN_STREAM(summary());
    } else {
      ROS_INFO_STREAM(summary());
    }
  }
  error_ = std::move(error);
  stopping_ = quitting_;
  settled_.notify_all();
}

}  // namespace afm::node
