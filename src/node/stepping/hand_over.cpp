#include "hand_over.h"

namespace afm::node {
namespace {

// A request causes at most four events beside batches: reset, drag applied, parameters applied, answer. Batches leave
// room for them, as a step reports its batches first and answers last.
constexpr std::size_t kEventsPerRequest = 4;
// Commands that may wait for publication, beside all the batches that may.
constexpr std::size_t kWaitingCommands = 1024;
constexpr std::size_t kWaitingStates = 4;  // of checkpoints; another is taken later

// A page touched for the first time costs the toucher a fault: touch them all before the stepping thread does.
template <class T>
void touch(boost::lockfree::spsc_queue<T>& queue) {
  while (queue.push(T{})) {
  }
  queue.reset();
}

BatchHead head_of(const Batch& batch) {
  return {batch.begin,
          batch.end,
          batch.first_sample_time,
          batch.first_sample,
          batch.vertical.size(),
          batch.first_impact,
          batch.impacts.size(),
          batch.friction,
          batch.eta,
          0};
}

template <class T>
void take_all(boost::lockfree::spsc_queue<T>& queue, std::size_t n, std::vector<T>& out) {
  out.resize(n);
  queue.pop(out.data(), n);
}

}  // namespace

HandOver::HandOver(const Capacity& capacity)
    : room_for_request_(capacity.batches + kEventsPerRequest),
      events_(room_for_request_ + kWaitingCommands),
      vertical_(capacity.samples),
      lateral_(capacity.samples),
      impacts_(capacity.impacts),
      states_(kWaitingStates) {
  touch(events_);
  touch(vertical_);
  touch(lateral_);
  touch(impacts_);
  touch(states_);
}

bool HandOver::offer(Event event, const Batch& batch) {
  const std::size_t samples = batch.vertical.size();
  if (events_.write_available() <= kEventsPerRequest || lateral_.write_available() < samples ||
      vertical_.write_available() < samples || impacts_.write_available() < batch.impacts.size()) {
    return false;
  }
  vertical_.push(batch.vertical.data(), samples);
  lateral_.push(batch.lateral.data(), samples);
  impacts_.push(batch.impacts.data(), batch.impacts.size());
  event.kind = Event::Kind::batch;
  const std::uint32_t stretch = event.batch.stretch;
  event.batch = head_of(batch);
  event.batch.stretch = stretch;
  return offer(event);  // last, as it is what makes the rest visible
}

bool HandOver::offer(const Event& event) {
  if (!events_.push(event)) return false;
  available_.post();
  return true;
}

bool HandOver::offer(Event event, const SavedState& state) {
  if (!has_room_for_request() || !states_.push(state)) return false;
  event.kind = Event::Kind::checkpoint;
  return offer(event);
}

bool HandOver::take(Event& event, Batch& batch, SavedState& state) {
  if (!events_.pop(event)) return false;
  if (event.kind == Event::Kind::checkpoint) states_.pop(state);
  if (event.kind != Event::Kind::batch) return true;
  const BatchHead& head = event.batch;
  batch.begin = head.begin;
  batch.end = head.end;
  batch.first_sample_time = head.first_sample_time;
  batch.first_sample = head.first_sample;
  batch.first_impact = head.first_impact;
  batch.friction = head.friction;
  batch.eta = head.eta;
  take_all(vertical_, head.samples, batch.vertical);
  take_all(lateral_, head.samples, batch.lateral);
  take_all(impacts_, head.impacts, batch.impacts);
  return true;
}

}  // namespace afm::node
