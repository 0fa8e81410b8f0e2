#include "run_view.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"
#include "node/publisher/messages.h"

namespace afm::view {
namespace {

constexpr double kKeptWallTime = 0.5;  // [s] of samples: impacts and samples travel on topics of their own
constexpr std::size_t kMostSamples = 2000000, kMostImpacts = 200000, kMostHeights = 1000;

using node::from_message;

bool begins_contact(const afm_emulator::Impact& impact) {
  return static_cast<ImpactKind>(impact.kind) == ImpactKind::contact_begun;
}

// The first in a deque that comes after a time.
template <class Items>
auto after(const Items& items, const ModelTime& time) {
  return std::upper_bound(items.begin(), items.end(), time, [](const ModelTime& t, const auto& item) {
    if constexpr (std::is_same_v<std::decay_t<decltype(item)>, afm_emulator::Impact>)
      return t < from_message(item.time);
    else
      return t < item.time;
  });
}

// At most so many of [begin, end), evenly.
template <class Iterator, class Use>
void take_evenly(Iterator begin, Iterator end, std::size_t most, const Use& use) {
  const auto count = static_cast<std::size_t>(end - begin), taken = std::min(count, most);
  for (std::size_t i = 0; i < taken; ++i) use(begin[static_cast<std::ptrdiff_t>(i * count / taken)]);
}

}  // namespace

void RunView::take(const afm_emulator::Configuration& message) {
  const SiModel si = node::to_parameters(message).si;
  configuration_ = message;
  units_ = Units(si);
  model_ = units_->to_natural(si);
}

void RunView::take(const afm_emulator::Applied& message) {
  const ModelTime time = from_message(message.time);
  if (message.epoch != heights_epoch_ || (!heights_.empty() && time < heights_.back().begin)) heights_.clear();
  heights_epoch_ = message.epoch;
  applied_ = message;
  heights_.push_back({time, message.rest_height_m});
  if (heights_.size() > kMostHeights) heights_.pop_front();
}

// Samples of another epoch, or before a gap, are forgotten.
void RunView::take(const afm_emulator::Deflection& message) {
  if (!units_ || message.vertical.empty()) return;
  if (message.epoch != samples_epoch_ || message.first_sample != next_sample_) samples_.clear();
  samples_epoch_ = message.epoch;
  const ModelTime begin = from_message(message.time);
  const double holder = message.holder_position / units_->length();
  const double eta = message.drag_velocity / units_->velocity();
  // the digits that the core uses, if what is in force is known already
  const bool as_applied = applied_ && message.sample_period == 1.0 / applied_->sample_rate_hz;
  const double period = as_applied ? applied_->sample_period_tau : message.sample_period / units_->time();
  for (std::size_t i = 0; i < message.vertical.size(); ++i) {
    const double since = static_cast<double>(i) * period;
    samples_.push_back({begin + since, holder + eta * since, eta, message.lateral[i] / units_->length(),
                        message.vertical[i] / units_->length()});
  }
  next_sample_ = message.first_sample + message.vertical.size();
  forget_old();
}

void RunView::take(const afm_emulator::ImpactArray& message) {
  if (message.epoch != impacts_epoch_ || message.first_index != next_impact_) {
    impacts_.clear();
    contact_before_ = false;
  }
  impacts_epoch_ = message.epoch;
  next_impact_ = message.first_index + message.impacts.size();
  impacts_.insert(impacts_.end(), message.impacts.begin(), message.impacts.end());
  forget_old();
}

void RunView::forget_old() {
  if (!configuration_ || !applied_ || samples_.empty()) return;
  const double kept = kPathTau / applied_->sample_period_tau + 4.0 * static_cast<double>(applied_->samples_per_batch) +
                      kKeptWallTime * applied_->sample_rate_hz * configuration_->time_scale;
  while (samples_.size() > std::min(kMostSamples, static_cast<std::size_t>(kept))) samples_.pop_front();
  const auto is_old = [&] {
    return impacts_.size() > kMostImpacts ||
           (impacts_epoch_ == samples_epoch_ && from_message(impacts_.front().time) < samples_.front().time);
  };
  for (; !impacts_.empty() && is_old(); impacts_.pop_front()) contact_before_ = begins_contact(impacts_.front());
}

bool RunView::complete() const {
  if (!configuration_ || samples_.empty() || heights_.empty()) return false;
  const std::uint32_t epoch = configuration_->epoch;
  return samples_epoch_ == epoch && impacts_epoch_ == epoch && heights_epoch_ == epoch;
}

double RunView::holder_x(const ModelTime& time) const {
  const auto next = after(samples_, time);
  const Sample& before = next == samples_.begin() ? *next : *std::prev(next);
  return before.holder + before.eta * (time - before.time);
}

double RunView::holder_y(const ModelTime& time) const {
  const auto found = std::find_if(heights_.rbegin(), heights_.rend(), [&](const Height& h) { return h.begin <= time; });
  return (found == heights_.rend() ? heights_.front() : *found).metres / units_->length();
}

bool RunView::in_contact(const ModelTime& time) const {
  const auto next = after(impacts_, time);
  return next == impacts_.begin() ? contact_before_ : begins_contact(*std::prev(next));
}

// The surface phase is exact; the cell is that of the sample before.
Place RunView::place(const afm_emulator::Impact& impact) const {
  const ModelTime time = from_message(impact.time);
  const auto next = after(samples_, time);
  const double X = next == samples_.begin() ? 0.0 : std::prev(next)->X;
  const double cells = std::round(holder_x(time) + X - impact.surface_phase);
  return {time,
          cells + impact.surface_phase,
          surface_jet(model_.H, impact.surface_phase).h,
          begins_contact(impact),
          impact.energy_loss,
          static_cast<ImpactKind>(impact.kind)};
}

std::vector<Place> RunView::samples_since(const ModelTime& from, std::size_t most) const {
  std::vector<Place> places;
  take_evenly(after(samples_, from), samples_.end(), most, [&](const Sample& s) {
    places.push_back({s.time, holder_x(s.time) + s.X, holder_y(s.time) + s.Y, in_contact(s.time)});
  });
  return places;
}

std::vector<Place> RunView::impacts_since(const ModelTime& from, std::size_t most) const {
  std::vector<Place> places;
  const auto begin = after(impacts_, from), end = std::max(begin, after(impacts_, now()));
  take_evenly(begin, end, most, [&](const afm_emulator::Impact& impact) { places.push_back(place(impact)); });
  return places;
}

}  // namespace afm::view
