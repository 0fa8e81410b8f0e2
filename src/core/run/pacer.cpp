#include "afm/pacer.h"

#include <algorithm>

namespace afm {
namespace {

double seconds(Pacer::Duration d) { return std::chrono::duration<double>(d).count(); }
constexpr double kFactorSpan = 1.0;  // [s] averaging time of the real-time factor, a choice

}  // namespace

Pacer::Pacer(Duration period, Duration start) : period_(period), origin_(start + period), mark_time_(start) {}

void Pacer::batch_done(Duration now) {
  lag_ = std::max(0.0, seconds(now - deadline()));
  worst_lag_ = std::max(worst_lag_, lag_);
  if (now > deadline() + period_) ++late_;
  ++due_;
  ++batches_;
  emulated_ += period_;
  const double span = seconds(now - mark_time_);
  if (span < kFactorSpan) return;
  factor_ = seconds(emulated_) / span;
  mark_time_ = now;
  emulated_ = Duration(0);
}

void Pacer::resume(Duration now) {
  lag_ = 0.0;
  origin_ = now + period_;
  due_ = 0;
  mark_time_ = now;
  emulated_ = Duration(0);
}

void Pacer::set_period(Duration period) {
  origin_ = deadline();
  due_ = 0;
  period_ = period;
}

}  // namespace afm
