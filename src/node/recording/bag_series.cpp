#include "bag_series.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bag_name.h"
#include "node/wire/message_conversion.h"
#include "node/stepping/scheduling.h"

namespace afm::node {
namespace {

// NAME, NAME_001, NAME_002: a shell lists NAME*.bag in this order.
std::string part_name(const std::string& name, std::uint32_t part) {
  if (part == 0) return name;
  char number[16];
  std::snprintf(number, sizeof number, "_%03u", part);
  return name + number;
}

ros::Time just_before(const ros::Time& stamp) { return stamp - ros::Duration(0, 1); }
ros::Time just_after(const ros::Time& stamp) { return stamp + ros::Duration(0, 1); }

}  // namespace

BagSeries::BagSeries(const Settings& settings, const std::string& directory, const std::string& name)
    : settings_(settings), directory_(directory), name_(without_bag_ending(name)), bag_(open(0)) {}

std::unique_ptr<BagFile> BagSeries::open(std::uint32_t part) const {
  return std::make_unique<BagFile>(directory_ + "/" + with_bag_ending(part_name(name_, part)), settings_.reserve_bytes,
                                   settings_.compression);
}

void BagSeries::begin_bag(const ros::Time& stamp) {
  begun_ = true;
  begin_stamp_ = stamp;
  if (part_ == 0) {
    mark(afm_emulator::Recording::BEGUN, just_before(stamp));  // the history comes through the queue
  } else {
    // all that follows is younger than what the bag before ended with
    mark(afm_emulator::Recording::BEGUN, just_before(last_stamp_));
    write_history();
  }
}

bool BagSeries::is_full(const ros::Time& stamp) const {
  const bool large = settings_.split_bytes > 0 && bag_->bytes() >= settings_.split_bytes;
  const bool long_enough = settings_.split_seconds > 0.0 && (stamp - begin_stamp_).toSec() >= settings_.split_seconds;
  return large || long_enough;
}

void BagSeries::split() {
  auto next = open(part_ + 1);  // first, as it may fail: then this bag is the last
  mark(afm_emulator::Recording::CONTINUED, just_after(last_stamp_));
  const std::string error = bag_->close();
  earlier_messages_ += bag_->messages();
  bag_ = std::move(next);
  ++part_;
  begun_ = false;
  if (!error.empty()) throw std::runtime_error(error);
}

void BagSeries::write_history() {
  if (!history_.configuration()) return;
  bag_->write(settings_.topics.configuration, last_stamp_, *history_.configuration());
  if (history_.checkpoint()) bag_->write(settings_.topics.checkpoint, last_stamp_, *history_.checkpoint());
  for (const auto& command : history_.commands()) bag_->write(settings_.topics.applied_drag, last_stamp_, *command);
  for (const auto& change : history_.changes()) bag_->write(settings_.topics.applied_parameters, last_stamp_, *change);
}

void BagSeries::mark(std::uint8_t kind, const ros::Time& stamp) {
  afm_emulator::Recording message;
  message.header.seq = marks_++;
  message.header.stamp = stamp;
  message.epoch = epoch_;
  message.kind = kind;
  message.name = name_;
  message.part = part_;
  message.messages = bag_->messages();
  message.dropped_messages = dropped_;
  bag_->write(settings_.topics.recording, stamp, message);
}

std::string BagSeries::close() {
  try {
    if (!begun_) begin_bag(to_stamp(wall_now_ns()));
    mark(afm_emulator::Recording::CLOSED, just_after(std::max(last_stamp_, begin_stamp_)));
  } catch (const std::exception&) {
    // closing fails for the same reason and reports it
  }
  return bag_->close();
}

}  // namespace afm::node
