#include "afterglow.h"

#include <algorithm>

namespace afm::view {
namespace {

// [begin, end), at most so many of them, evenly.
template <class Iterator, class Use>
void take_evenly(Iterator begin, Iterator end, std::size_t most, const Use& use) {
  const auto count = static_cast<std::size_t>(end - begin);
  const std::size_t taken = std::min(count, most);
  for (std::size_t i = 0; i < taken; ++i) use(begin[static_cast<std::ptrdiff_t>(i * count / taken)]);
}

template <class Item>
auto first_from(const std::deque<Item>& items, std::uint64_t index) {
  return std::lower_bound(items.begin(), items.end(), index,
                          [](const Item& item, std::uint64_t wanted) { return item.index < wanted; });
}

}  // namespace

void Afterglow::look(const RunView& run, const Strobe& strobe) {
  if (run.configuration().epoch != epoch_ || run.now() < now_) clear();
  epoch_ = run.configuration().epoch;
  now_ = run.now();
  ++picture_;
  take_impacts(run, strobe.too_fast());
  take_positions(run, strobe.too_fast());
  forget();
}

void Afterglow::take_impacts(const RunView& run, bool too_fast) {
  const auto& events = run.trace().events();
  const auto end = std::upper_bound(events.begin(), events.end(), now_,
                                    [](const ModelTime& t, const Event& e) { return t < e.impact.time; });
  auto begin = first_from(events, next_event_);
  if (!too_fast) {  // all that the path shows
    impacts_.clear();
    begin = std::lower_bound(events.begin(), end, now_ + -kPathTau,
                             [](const Event& e, const ModelTime& t) { return e.impact.time < t; });
  }
  if (begin >= end) return;
  next_event_ = std::prev(end)->index + 1;
  take_evenly(begin, end, too_fast ? kNewImpacts : kMostImpacts, [&](const Event& event) {
    const Corner corner = run.trace().place(event, run.model(), run.holder());
    impacts_.push_back({corner, event.impact.energy_loss, event.impact.kind, picture_});
  });
}

void Afterglow::take_positions(const RunView& run, bool wanted) {
  const auto& samples = run.trace().samples();
  const auto begin = first_from(samples, next_sample_);
  next_sample_ = samples.back().index + 1;
  if (!wanted) return positions_.clear();
  take_evenly(begin, samples.end(), kNewPositions, [&](const Sample& sample) {
    const double x = run.holder().position(sample.time) + sample.X;
    const Corner corner{sample.time, x, run.holder().height(sample.time) + sample.Y,
                        run.trace().in_contact(sample.time)};
    positions_.push_back({corner, 0.0, ImpactKind::impact, picture_});
  });
}

void Afterglow::forget() {
  const auto is_old = [&](const Spot& spot) { return spot.picture + kGlow < picture_; };
  while (!impacts_.empty() && is_old(impacts_.front())) impacts_.pop_front();
  while (!positions_.empty() && is_old(positions_.front())) positions_.pop_front();
}

}  // namespace afm::view
