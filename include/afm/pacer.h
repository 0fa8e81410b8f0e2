// Pacing of batches: which batch is due at a wall time, how late we are, and how many batches were late. It reads no
// clock; the time is an argument.
#pragma once

#include <chrono>
#include <cstdint>

namespace afm {

class Pacer {
 public:
  using Duration = std::chrono::nanoseconds;  // since any fixed point of a monotonic clock

  // period: wall time between batches.
  Pacer(Duration period, Duration start);

  Duration deadline() const { return origin_ + due_ * period_; }  // of the next batch: absolute, so delays never add up
  void batch_done(Duration now);     // the batch due at deadline() is complete
  void resume(Duration now);         // begins anew: after a pause, and at a reset, no delay is left
  void set_period(Duration period);  // for the batches after the next one

  double lag() const { return lag_; }              // [s] delay of the last batch behind the end of its period
  double worst_lag() const { return worst_lag_; }  // [s]
  std::uint64_t batches() const { return batches_; }
  std::uint64_t late_batches() const { return late_; }  // completed after the next one was due
  double real_time_factor() const { return factor_; }   // time emulated over wall time, over the last second or so

 private:
  Duration period_;
  Duration origin_;       // wall time at which batch 0 was due
  std::int64_t due_ = 0;  // batches since origin_
  std::uint64_t batches_ = 0, late_ = 0;
  double lag_ = 0.0, worst_lag_ = 0.0;
  // real-time factor: a reference point that moves up about once a second
  Duration mark_time_;
  Duration emulated_{0};  // since the reference point
  double factor_ = 1.0;
};

}  // namespace afm
