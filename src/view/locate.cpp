#include <algorithm>
#include <cmath>
#include <optional>

#include "afm/detail/turns.h"
#include "trace.h"

namespace afm::view {
namespace {

constexpr std::ptrdiff_t kEventsLookedAt = 200;
constexpr double kLeastSine = 0.1;  // samples nearly half a turn apart say little about what is between them

// The spring through two samples, at a time after them; empty if they do not determine it.
std::optional<double> extension_at(const ModelTime& time, const Sample& a, const Sample& b, double frequency_ratio) {
  const auto sine = [&](double dt) { return sin_cos_turns(frequency_ratio * dt).sin; };
  const double spread = sine(b.time - a.time);
  if (std::abs(spread) < kLeastSine) return {};
  return (b.X * sine(time - a.time) - a.X * sine(time - b.time)) / spread;
}

// A burst is reported when it has ended, and a contact slides: neither ends or begins a free flight for certain.
bool begins_flight(const Event& event) {
  return event.impact.kind == ImpactKind::impact || event.impact.kind == ImpactKind::contact_ended;
}

}  // namespace

void locate(const Trace& trace, const Model& model, Holder& holder) {
  const auto& events = trace.events();
  const auto& samples = trace.samples();
  const auto last = events.end();
  const auto first = last - std::min<std::ptrdiff_t>(kEventsLookedAt, last - events.begin());
  for (auto event = last; event != first && event != events.begin() && std::prev(event) != events.begin();) {
    --event;
    const auto before = std::prev(event);
    const ModelTime& time = event->impact.time;
    const auto after = std::upper_bound(samples.begin(), samples.end(), time,
                                        [](const ModelTime& t, const Sample& s) { return t < s.time; });
    if (after == samples.end() || after - samples.begin() < 2) continue;  // not heard yet, or no longer known
    const Sample& b = *std::prev(after);
    const Sample& a = *std::prev(after, 2);
    const bool flies =
        begins_flight(*before) && before->impact.time < a.time && event->impact.kind == ImpactKind::impact;
    if (!flies || a.time < holder.last_change(time)) continue;
    const auto X = extension_at(time, a, b, model.frequency_ratio);
    if (X) return holder.correct(time, event->impact.surface_phase - *X);
  }
}

}  // namespace afm::view
