#include "holder.h"

#include <algorithm>
#include <cmath>

#include "node/wire/message_conversion.h"

namespace afm::view {
namespace {

constexpr std::size_t kMostLegs = 1000;  // a picture reaches back over few of them
constexpr std::size_t kMostLifts = kMostLegs;

}  // namespace

void Holder::begin(const afm_emulator::Configuration& configuration) {
  configured_ = true;
  start_epoch_ = configuration.epoch;
  start_ = configuration.initial_phase - configuration.initial_extension;
  start_height_m_ = configuration.rest_height_m;
  length_unit_ = configuration.lattice_spacing_m;
  const double speed_unit = Units(node::si_model(configuration)).velocity();
  for (Leg& leg : legs_) leg.eta *= speed_unit_ / speed_unit;  // a command may come before the first configuration
  speed_unit_ = speed_unit;
}

void Holder::obey(const afm_emulator::AppliedDrag& command) {
  const ModelTime time = node::from_message(command.time);
  if (command.epoch != epoch_ || (!legs_.empty() && time < legs_.back().begin)) {
    legs_.clear();
    correction_.reset();
  }
  epoch_ = command.epoch;
  const double eta = command.drag_velocity / speed_unit_;
  const double x = legs_.empty() ? 0.0 : travelled(time);
  if (!legs_.empty() && legs_.back().begin == time) legs_.pop_back();
  legs_.push_back({time, x, eta});
  if (legs_.size() > kMostLegs) legs_.pop_front();
}

void Holder::correct(const ModelTime& time, double x) {
  if (legs_.empty()) return;
  const double now = position(time).value_or(travelled(time));
  const double error = x - now;
  correction_ = now + (error - std::round(error)) - travelled(time);
}

std::optional<double> Holder::position(const ModelTime& time) const {
  if (legs_.empty() || !(correction_ || knows_start())) return std::nullopt;
  return travelled(time) + correction_.value_or(start_);
}

// The first command of an epoch is the drag at its start, at time 0: who heard that one has missed none.
bool Holder::knows_start() const {
  return configured_ && start_epoch_ == epoch_ && legs_.size() < kMostLegs && legs_.front().begin == ModelTime{};
}

const Holder::Leg& Holder::leg(const ModelTime& time) const {
  static const Leg standstill;
  for (auto leg = legs_.rbegin(); leg != legs_.rend(); ++leg) {
    if (leg->begin <= time) return *leg;
  }
  return legs_.empty() ? standstill : legs_.front();
}

double Holder::travelled(const ModelTime& time) const {
  const Leg& now = leg(time);
  return now.x + now.eta * (time - now.begin);
}

void Holder::obey(const afm_emulator::AppliedParameters& change) {
  const ModelTime time = node::from_message(change.time);
  if (change.epoch != lifts_epoch_ || (!lifts_.empty() && time < lifts_.back().begin)) lifts_.clear();
  lifts_epoch_ = change.epoch;
  lifts_.push_back({time, change.rest_height_m});
  if (lifts_.size() > kMostLifts) lifts_.pop_front();
}

double Holder::height(const ModelTime& time) const {
  const auto after = std::upper_bound(lifts_.begin(), lifts_.end(), time,
                                      [](const ModelTime& t, const Lift& lift) { return t < lift.begin; });
  const bool lifted = lifts_epoch_ == start_epoch_ && after != lifts_.begin();
  return (lifted ? std::prev(after)->height_m : start_height_m_) / length_unit_;
}

}  // namespace afm::view
