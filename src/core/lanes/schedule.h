// Which tips are packed together: each of a window of tips waits in a list for what it needs next, and a pack is made
// from the longest, so that hardly a lane idles however the flights differ.
#pragma once

#include "bounce.h"
#include "look.h"
#include "root.h"

namespace afm {
namespace {

constexpr std::uint32_t kWindow = 128;  // in which lists fill packs, and which the nearest caches still hold

struct List {
  LaneTip* tips[kWindow];
  std::uint32_t size = 0;

  AFM_LANE_INLINE void push(LaneTip* tip) { tips[size++] = tip; }
};

#ifdef __clang__
#define AFM_LANE_KERNEL __attribute__((noinline))
#else
#define AFM_LANE_KERNEL __attribute__((noinline, flatten))
#endif

class Schedule {
 public:
  explicit Schedule(const Work& work) : work_(work) {}

  void run() {
    for (;;) {
      while (flying_ < kWindow && next_ < work_.size) {
        ++flying_;
        admit(work_.tips[next_++]);
      }
      if (flying_ == 0) return;
      fly(longest());
    }
  }

 private:
  Kind longest() const {
    int kind = 0;
    for (int k = 1; k < kKinds; ++k) {
      if (lists_[k].size > lists_[kind].size) kind = k;
    }
    return static_cast<Kind>(kind);
  }

  // A tip that has come in or was alone. What one must do alone it does at once.
  void admit(LaneTip& tip) {
    if (tip.waits || (tip.stage == Stage::single && !work_.single(work_.context, tip))) {
      --flying_;
    } else if (tip.stage == Stage::bounce) {
      lists_[kBounce].push(&tip);
    } else {
      const bool near = (tip.row[kS] + tip.row[kAhead]) * tip.row[kFastest] <= kSmallTurn;
      lists_[near ? kLookNear : kLookFar].push(&tip);
    }
  }

  // Every full pack that waits for this now; or the one that is not full.
  void fly(Kind kind) {
    List& list = lists_[kind];
    LaneTip* tips[kLanes];
    if (list.size < kLanes) {
      for (std::uint32_t i = 0; i < kLanes; ++i) tips[i] = i < list.size ? list.tips[i] : work_.spare;
      const unsigned there = (1u << list.size) - 1u;
      list.size = 0;
      return fly_pack(tips, kind, there);
    }
    for (std::uint32_t packs = list.size / kLanes; packs > 0; --packs) {
      list.size -= kLanes;
      for (std::uint32_t i = 0; i < kLanes; ++i) tips[i] = list.tips[list.size + i];
      fly_pack(tips, kind, kAllLanes);
    }
  }

  // A full pack for as long as all go the same way, another once.
  void fly_pack(LaneTip* const* tips, Kind kind, unsigned there) {
    Live live(tips, kind);
    for (;;) {
      Ways ways = step(kind, live);
      const unsigned stop = kind == kBounce ? count_bounces(tips, there, ways) : 0u;
      const int next = stop == 0 && there == kAllLanes ? ways.common() : kKinds;
      if (next == kKinds || (next == kFinishFar && !live.whole)) {
        live.store();
        return part(tips, there, stop, ways);
      }
      kind = static_cast<Kind>(next);
    }
  }

  template <Kind kKind>
  static AFM_LANE_KERNEL Ways step_of(Live& live) {
    if constexpr (kKind == kBounce) {
      return bounce(live);
    } else if constexpr (kKind == kLookNear || kKind == kLookFar) {
      return look<kKind>(live);
    } else {
      return finish<kKind>(live);
    }
  }
  static Ways step(Kind kind, Live& live) {
    constexpr Ways (*kSteps[])(Live&) = {step_of<kLookNear>,   step_of<kLookFar>,    step_of<kFinishHere>,
                                         step_of<kFinishTiny>, step_of<kFinishNear>, step_of<kFinishFar>,
                                         step_of<kBounce>};
    static_assert(sizeof kSteps / sizeof *kSteps == kKinds, "one for each kind, in their order");
    return kSteps[kind](live);
  }

  // Each into the list of what it needs next.
  void part(LaneTip* const* tips, unsigned there, unsigned stop, Ways& ways) {
    if (stop != 0) stop_after_bounce(tips, stop, ways);
    for (int k = 0; k < kKinds; ++k) sort(lists_[k], tips, ways.lanes[k] & there);
    for (unsigned left = ways.lanes[kLimited] & there; left != 0; left &= left - 1) wait(*tips[__builtin_ctz(left)]);
    if ((ways.lanes[kAlone] & there) != 0) all_alone(tips, ways.lanes[kAlone] & there);
  }

  static AFM_LANE_INLINE void sort(List& list, LaneTip* const* tips, unsigned lanes) {
    if (lanes == kAllLanes) {
      for (int i = 0; i < kLanes; ++i) list.tips[list.size + static_cast<std::uint32_t>(i)] = tips[i];
      list.size += kLanes;
    } else {
      for (; lanes != 0; lanes &= lanes - 1) list.push(tips[__builtin_ctz(lanes)]);
    }
  }

  // Those with all their events go no further, nor do those that must bounce alone as yet.
  unsigned count_bounces(LaneTip* const* tips, unsigned there, Ways& ways) const {
    unsigned stop = ways.lanes[kAlone] & there;
    ways.lanes[kAlone] = 0;
    for (int i = 0; i < kLanes; ++i) {
      LaneTip& tip = *tips[i];
      tip.bounced = true;
      if (++tip.events == work_.most_events) stop |= 1u << i & there;
      if (tip.log != nullptr) *tip.log++ = tip.last;
    }
    return stop;
  }
  void wait(LaneTip& tip) {
    tip.stage = Stage::bounce;
    tip.waits = true;
    --flying_;
  }

  __attribute__((noinline)) void stop_after_bounce(LaneTip* const* tips, unsigned stop, Ways& ways) {
    LaneTip* stopped[kLanes];
    int n = 0;
    for (; stop != 0; stop &= stop - 1) {
      const int i = __builtin_ctz(stop);
      const unsigned lane = 1u << i;
      const bool ordinary = ((ways.lanes[kLookNear] | ways.lanes[kLookFar]) & lane) != 0;
      tips[i]->stage = ordinary ? Stage::look : Stage::single;
      tips[i]->stuck = false;
      for (unsigned& lanes : ways.lanes) lanes &= ~lane;
      stopped[n++] = tips[i];
    }
    for (int i = 0; i < n; ++i) {
      if (stopped[i]->events == work_.most_events) {
        --flying_;
      } else {
        admit(*stopped[i]);
      }
    }
  }

  __attribute__((noinline)) void all_alone(LaneTip* const* tips, unsigned lanes) {
    LaneTip* left[kLanes];
    int n = 0;
    for (; lanes != 0; lanes &= lanes - 1) left[n++] = tips[__builtin_ctz(lanes)];
    for (int i = 0; i < n; ++i) {
      left[i]->stage = Stage::single;
      left[i]->stuck = true;
      admit(*left[i]);
    }
  }

  const Work& work_;
  List lists_[kKinds];
  std::uint32_t flying_ = 0, next_ = 0;
};

}  // namespace
}  // namespace afm
