#include "run_view.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"
#include "node/publisher/messages.h"

namespace afm::view {
namespace {

constexpr double kKeptWallTime = 0.5;  // [s] of samples: impacts and samples travel on topics of their own
constexpr std::size_t kMostSamples = 2000000, kMostImpacts = 200000;

using afm_emulator::Impact;
using node::from_message;

ModelTime time_of(const Place& place) { return place.time; }
ModelTime time_of(const Impact& impact) { return from_message(impact.time); }

bool begins_contact(const Impact& impact) { return static_cast<ImpactKind>(impact.kind) == ImpactKind::contact_begun; }

// The first in a deque that comes after a time.
template <class Items>
auto after(const Items& items, const ModelTime& time) {
  return std::upper_bound(items.begin(), items.end(), time,
                          [](const ModelTime& t, const auto& item) { return t < time_of(item); });
}

// At most so many of [begin, end), evenly.
template <class Iterator, class MakePlace>
std::vector<Place> evenly(Iterator begin, Iterator end, std::size_t most, const MakePlace& make_place) {
  const auto count = static_cast<std::size_t>(std::max(end - begin, std::ptrdiff_t{0})), taken = std::min(count, most);
  std::vector<Place> places(taken);
  for (std::size_t i = 0; i < taken; ++i) places[i] = make_place(begin[static_cast<std::ptrdiff_t>(i * count / taken)]);
  return places;
}

}  // namespace

void RunView::take(const afm_emulator::Configuration& message) {
  const SiModel si = node::to_parameters(message).si;
  configuration_ = message;
  units_ = Units(si);
  model_ = units_->to_natural(si);
}

void RunView::take(const afm_emulator::Applied& message) {
  if (!applied_.empty() && applied_.back().epoch != message.epoch) applied_.clear();
  if (!applied_.empty() && applied_.back().first_sample == message.first_sample) applied_.pop_back();
  applied_.push_back(message);
}

void RunView::take(const afm_emulator::Deflection& message) {
  if (!units_ || applied_.empty() || applied_.front().epoch != message.epoch || message.vertical.empty()) return;
  while (applied_.size() > 1 && applied_[1].first_sample <= message.first_sample) applied_.pop_front();
  if (message.epoch != samples_epoch_ || message.first_sample != next_sample_) samples_.clear();
  samples_epoch_ = message.epoch;
  next_sample_ = message.first_sample + message.vertical.size();
  const double unit = units_->length(), period = message.sample_period / units_->time();
  const double begin = message.holder_position / unit;
  eta_ = message.drag_velocity / units_->velocity();
  for (std::size_t i = 0; i < message.vertical.size(); ++i) {
    const double since = static_cast<double>(i) * period;
    holder_ = {from_message(message.time) + since, begin + eta_ * since, applied_.front().rest_height_m / unit};
    samples_.push_back({holder_.time, holder_.x + message.lateral[i] / unit, holder_.y + message.vertical[i] / unit});
  }
  forget_old();
}

void RunView::take(const afm_emulator::ImpactArray& message) {
  if (message.epoch != impacts_epoch_ || message.first_index != next_impact_) {
    impacts_.clear();
    contact_before_.reset();
  }
  impacts_epoch_ = message.epoch;
  next_impact_ = message.first_index + message.impacts.size();
  impacts_.insert(impacts_.end(), message.impacts.begin(), message.impacts.end());
  forget_old();
}

void RunView::forget_old() {
  if (!configuration_ || samples_.empty()) return;
  const double kept = std::max(kPathTau, kKeptWallTime * configuration_->time_scale / units_->time());
  const auto has_old = [&] { return samples_.size() > 2 && samples_.front().time < now() + -kept; };
  while (has_old() || samples_.size() > kMostSamples) samples_.pop_front();
  const auto is_old = [&] {
    return impacts_.size() > kMostImpacts ||
           (impacts_epoch_ == samples_epoch_ && time_of(impacts_.front()) < samples_.front().time);
  };
  for (; !impacts_.empty() && is_old(); impacts_.pop_front()) contact_before_ = begins_contact(impacts_.front());
}

bool RunView::complete() const {
  return configuration_ && !applied_.empty() && samples_.size() > 1 && samples_epoch_ == configuration_->epoch &&
         impacts_epoch_ == configuration_->epoch;
}

// Who begins to look at a tip that rests for good hears of no event. Until the first one chatter counts as contact.
bool RunView::in_contact(const Place& sample) const {
  constexpr double kTouches = 1e-6;  // [a] a choice: far above rounding, and far below what a picture shows
  const auto next = after(impacts_, sample.time);
  if (next != impacts_.begin()) return begins_contact(*std::prev(next));
  if (contact_before_) return *contact_before_;
  return sample.y - surface_jet(model_.H, sample.x - std::floor(sample.x)).h < kTouches;
}

// The surface phase is exact; the cell is that of the samples around it.
Place RunView::place(const Impact& impact) const {
  const ModelTime time = time_of(impact);
  const auto next = std::clamp(after(samples_, time), samples_.begin() + 1, samples_.end() - 1);
  const auto before = std::prev(next);
  const double slope = (next->x - before->x) / (next->time - before->time);
  const double x = before->x + slope * (time - before->time);
  return {time,
          std::round(x - impact.surface_phase) + impact.surface_phase,
          surface_jet(model_.H, impact.surface_phase).h,
          begins_contact(impact),
          impact.energy_loss,
          static_cast<ImpactKind>(impact.kind)};
}

std::vector<Place> RunView::samples_since(const ModelTime& from, std::size_t most) const {
  return evenly(after(samples_, from), samples_.end(), most, [&](Place sample) {
    sample.contact = in_contact(sample);
    return sample;
  });
}

std::vector<Place> RunView::impacts_since(const ModelTime& from, std::size_t most) const {
  return evenly(after(impacts_, from), after(impacts_, now()), most,
                [&](const Impact& impact) { return place(impact); });
}

}  // namespace afm::view
