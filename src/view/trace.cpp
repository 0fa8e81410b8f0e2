#include "trace.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"
#include "node/publisher/messages.h"

namespace afm::view {
namespace {

constexpr std::size_t kMostEvents = 200000;

bool before_sample(const ModelTime& time, const Sample& sample) { return time < sample.time; }
bool before_event(const ModelTime& time, const Event& event) { return time < event.impact.time; }

Impact to_impact(const afm_emulator::Impact& message, const Units& units) {
  Impact impact;
  impact.time = node::from_message(message.time);
  impact.surface_phase = message.surface_phase;
  impact.energy_loss = message.energy_loss / units.energy();
  impact.kind = static_cast<ImpactKind>(message.kind);
  return impact;
}

}  // namespace

void Trace::add(const afm_emulator::Deflection& message, const Units& units, double sample_period_tau) {
  if (message.epoch != samples_epoch_ || message.first_sample != next_sample_) samples_.clear();
  samples_epoch_ = message.epoch;
  const ModelTime first = node::from_message(message.time);
  const std::size_t count = std::min(message.vertical.size(), message.lateral.size());
  for (std::size_t i = 0; i < count; ++i) {
    samples_.push_back({message.first_sample + i, first + static_cast<double>(i) * sample_period_tau,
                        message.lateral[i] / units.length(), message.vertical[i] / units.length()});
  }
  next_sample_ = message.first_sample + count;
  forget_old();
}

void Trace::add(const afm_emulator::ImpactArray& message, const Units& units) {
  if (message.epoch != events_epoch_ || message.first_index != next_event_) {
    events_.clear();
    contact_before_ = false;
  }
  events_epoch_ = message.epoch;
  next_event_ = message.first_index;
  for (const afm_emulator::Impact& published : message.impacts) {
    const Impact impact = to_impact(published, units);
    events_.push_back({next_event_++, impact, impact.kind == ImpactKind::contact_begun});
  }
  forget_old();
}

void Trace::forget_old() {
  while (samples_.size() > kept_samples_) samples_.pop_front();
  while (!events_.empty() && !samples_.empty() &&
         (events_.size() > kMostEvents ||
          (events_epoch_ == samples_epoch_ && events_.front().impact.time < samples_.front().time))) {
    contact_before_ = events_.front().contact;
    events_.pop_front();
  }
}

bool Trace::in_contact(const ModelTime& time) const {
  const auto after = std::upper_bound(events_.begin(), events_.end(), time, before_event);
  return after == events_.begin() ? contact_before_ : std::prev(after)->contact;
}

Corner Trace::place(const Event& event, const Model& model, const Holder& holder) const {
  const Impact& impact = event.impact;
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), impact.time, before_sample);
  const double X = after == samples_.begin() ? 0.0 : std::prev(after)->X;
  const double cells = std::round(holder.position(impact.time) + X - impact.surface_phase);
  return {impact.time, cells + impact.surface_phase, surface_jet(model.H, impact.surface_phase).h, event.contact};
}

std::vector<Corner> Trace::path(const ModelTime& from, const Model& model, const Holder& holder) const {
  std::vector<Corner> corners;
  auto sample = std::lower_bound(samples_.begin(), samples_.end(), from,
                                 [](const Sample& s, const ModelTime& time) { return s.time < time; });
  auto event = std::upper_bound(events_.begin(), events_.end(), from, before_event);
  for (; sample != samples_.end(); ++sample) {
    for (; event != events_.end() && event->impact.time <= sample->time; ++event) {
      corners.push_back(place(*event, model, holder));
    }
    const bool contact = event == events_.begin() ? contact_before_ : std::prev(event)->contact;
    const double centre = holder.position(sample->time);
    corners.push_back({sample->time, centre + sample->X, holder.height(sample->time) + sample->Y, contact});
  }
  return corners;
}

}  // namespace afm::view
