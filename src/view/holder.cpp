#include "holder.h"

#include "node/publisher/messages.h"

namespace afm::view {
namespace {

constexpr std::size_t kMostLegs = 1000;  // a picture reaches back over few of them

}  // namespace

void Holder::take(const afm_emulator::Applied& applied) {
  const ModelTime time = node::from_message(applied.time);
  if (applied.epoch != epoch_ || (!legs_.empty() && time < legs_.back().begin)) legs_.clear();
  epoch_ = applied.epoch;
  const double x = legs_.empty() ? 0.0 : travelled(time);
  if (!legs_.empty() && legs_.back().begin == time) legs_.pop_back();
  legs_.push_back({time, x, applied.drag_velocity, applied.rest_height_m});
  if (legs_.size() > kMostLegs) legs_.pop_front();
}

void Holder::take(const afm_emulator::Deflection& batch) {
  if (batch.vertical.empty()) return;  // the drag may change before its next sample
  place_time_ = node::from_message(batch.time);
  place_ = batch.holder_position;
  place_epoch_ = batch.epoch;
  placed_ = true;
}

const Holder::Leg& Holder::leg(const ModelTime& time) const {
  for (auto leg = legs_.rbegin(); leg != legs_.rend(); ++leg) {
    if (leg->begin <= time) return *leg;
  }
  return legs_.front();
}

double Holder::travelled(const ModelTime& time) const {
  const Leg& now = leg(time);
  return now.travelled + now.drag_velocity * (time - now.begin);
}

double Holder::position(const ModelTime& time) const {
  return place_ / units_.length() + (travelled(time) - travelled(place_time_)) / units_.velocity();
}

double Holder::height(const ModelTime& time) const { return leg(time).height / units_.length(); }
double Holder::eta(const ModelTime& time) const { return leg(time).drag_velocity / units_.velocity(); }

}  // namespace afm::view
