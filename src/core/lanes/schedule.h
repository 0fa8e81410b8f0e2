// Which tips are packed together: of a window of tips each waits in the list of its stage until a pack of its kind is full, so
// that no lane idles however their flights differ.
#pragma once

#include "kernels.h"

namespace afm {
namespace {

constexpr std::uint32_t kWindow = 64;

struct List {
  LaneTip* tips[kWindow];
  std::uint32_t size = 0;

  AFM_LANE_INLINE void push(LaneTip* tip) { tips[size++] = tip; }
};

class Schedule {
 public:
  explicit Schedule(const Work& work) : work_(work) {
    const Pack zero = Pack(0.0);
    limit_ = {add_whole(each([&](int) { return filled_bits(work.limit.tau); }), zero), Pack(work.limit.phase)};
  }

  void run() {
    for (;;) {
      refill();
      if (flying_ == 0) return;
      // a full pack of any kind first; else the longest list
      if (full(look_) || (look_.size > 0 && !full(finish_) && !full(bounce_) && longest(look_))) {
        looks();
      } else if (full(finish_) || (finish_.size > 0 && !full(bounce_) && longest(finish_))) {
        finishes();
      } else {
        bounces();
      }
    }
  }

 private:
  static bool full(const List& list) { return list.size >= kLanes; }
  bool longest(const List& list) const {
    return list.size >= look_.size && list.size >= finish_.size && list.size >= bounce_.size;
  }

  void refill() {
    while (flying_ < kWindow && next_ < work_.size) {
      ++flying_;
      admit(work_.tips[next_++]);
    }
  }

  // A tip by its stage; what one must do alone it does at once.
  void admit(LaneTip& tip) {
    if (tip.waits || (tip.stage == Stage::single && !work_.single(work_.context, tip))) {
      --flying_;
    } else if (tip.stage == Stage::bounce) {
      bounce_.push(&tip);
    } else {
      look_.push(&tip);
    }
  }

  // The last of the list, filled up with the spare; how many are tips.
  int take(List& list, LaneTip** tips) const {
    const int n = list.size < kLanes ? static_cast<int>(list.size) : kLanes;
    list.size -= static_cast<std::uint32_t>(n);
    for (int i = 0; i < kLanes; ++i)
      tips[i] = i < n ? list.tips[list.size + static_cast<std::uint32_t>(i)] : work_.spare;
    return n;
  }

  void alone(LaneTip& tip) {
    tip.stage = Stage::single;
    tip.stuck = true;
    admit(tip);
  }

  void looks();
  void finishes();
  void bounces();

  const Work& work_;
  PackTime limit_;
  List look_, finish_, bounce_;
  std::uint32_t flying_ = 0, next_ = 0;
};

#ifdef __clang__
#define AFM_LANE_KERNEL __attribute__((noinline))
#else
#define AFM_LANE_KERNEL __attribute__((noinline, flatten))
#endif

AFM_LANE_KERNEL Next look_at(LaneTip* const* tips) { return look(tips); }
AFM_LANE_KERNEL Next finish_of(LaneTip* const* tips, const PackTime& limit, unsigned& limited) {
  return finish(tips, limit, limited);
}
AFM_LANE_KERNEL Next bounce_of(LaneTip* const* tips) { return bounce(tips); }

inline void Schedule::looks() {
  LaneTip* tips[kLanes];
  const int n = take(look_, tips);
  const Next next = look_at(tips);
  for (int i = 0; i < n; ++i) {
    LaneTip& tip = *tips[i];
    if ((next.on >> i & 1u) != 0) {
      tip.stage = Stage::finish;
      finish_.push(&tip);
    } else if ((next.single >> i & 1u) != 0 || ++tip.looks > kMaxLooks) {
      alone(tip);
    } else {
      look_.push(&tip);
    }
  }
}

inline void Schedule::finishes() {
  LaneTip* tips[kLanes];
  const int n = take(finish_, tips);
  unsigned limited = 0;
  const Next next = finish_of(tips, limit_, limited);
  for (int i = 0; i < n; ++i) {
    LaneTip& tip = *tips[i];
    if ((next.single >> i & 1u) != 0) {
      alone(tip);
      continue;
    }
    tip.stage = Stage::bounce;
    tip.waits = (limited >> i & 1u) != 0;
    if (tip.waits) {
      --flying_;
    } else {
      bounce_.push(&tip);
    }
  }
}

inline void Schedule::bounces() {
  LaneTip* tips[kLanes];
  const int n = take(bounce_, tips);
  const Next next = bounce_of(tips);
  for (int i = 0; i < n; ++i) {
    LaneTip& tip = *tips[i];
    if (tip.log != nullptr) *tip.log++ = tip.last;
    tip.looks = 0;
    tip.bounced = true;
    tip.stage = (next.on >> i & 1u) != 0 ? Stage::look : Stage::single;
    if (++tip.events == work_.most_events) {
      --flying_;
    } else {
      admit(tip);
    }
  }
}

}  // namespace
}  // namespace afm
