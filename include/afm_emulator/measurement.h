// The figures of a control period in real time: those of the service ~control, from the batches that are published.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Control.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/ModelTime.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

namespace afm_emulator {

// Model time from one to the other [tau].
inline double tau_between(const ModelTime& begin, const ModelTime& end) {
  return static_cast<double>(end.tau - begin.tau) + (end.phase - begin.phase);
}

// Sums over the batches of a period, which come in order and without a gap.
class Measurement {
 public:
  struct Lever {
    double tau_s, stiffness, lateral_stiffness;  // [s], [N/m]
  };

  // since: in force at its begin
  explicit Measurement(const Applied& since)
      : since_(since), begin_(since.time), end_(since.time), last_begin_(since.time) {}

  void add(const Deflection& batch) {
    if (!last_) first_ = batch.header.seq;
    last_ = batch.header.seq;
    last_begin_ = batch.time;
    same_speed_ = same_speed_ && batch.drag_velocity == since_.drag_velocity;
    samples_ += batch.vertical.size();
    for (const double y : batch.vertical) vertical_ += y, vertical_squares_ += y * y;
    for (const double x : batch.lateral) lateral_squares_ += x * x;
    impulse_ += batch.lateral_impulse;
    seconds_ += static_cast<double>(batch.vertical.size()) * batch.sample_period;
  }

  // Both after the batch they belong to, in order: those of other batches do not count.
  void add(const ImpactArray& batch) {
    if (!is_of_period(batch.header)) return;
    ++with_impacts_;
    for (const Impact& impact : batch.impacts) impact_count_ += impact.count, energy_loss_ += impact.energy_loss;
  }

  void add(const Friction& batch) {
    // a period of no length: now
    if (!last_ && batch.epoch == since_.epoch && tau_between(end_, batch.time) > 0.0) begin_ = end_ = batch.time;
    if (!is_of_period(batch.header)) return;
    if (++with_friction_ == 1) begin_ = batch.begin;
    end_ = batch.time;
  }

  // Of model time, by the samples: batches may begin and end between them.
  double seconds() const { return seconds_; }
  const std::optional<std::uint32_t>& last() const { return last_; }  // header.seq of the last batch
  std::uint32_t without_impacts() const { return batches() - with_impacts_; }
  std::uint32_t without_friction() const { return batches() - with_friction_; }

  // As the emulator gives it in lockstep. applied: the messages since its begin.
  Control::Response answer(const std::deque<Applied::ConstPtr>& applied, const Lever& lever) const {
    Control::Response r;
    r.success = true;
    r.epoch = since_.epoch;
    r.begin = begin_;
    r.end = end_;
    r.samples = samples_;
    const double n = static_cast<double>(samples_), seconds = tau_between(begin_, end_) * lever.tau_s;
    r.applied = since_.number;
    for (const Applied::ConstPtr& m : applied) {  // they act where a batch begins
      const bool holds = m->epoch == since_.epoch && tau_between(m->time, last_begin_) >= 0.0;
      if (holds) r.applied = std::max(r.applied, m->number);
    }
    r.mean_vertical = vertical_ / n;
    r.rms_vertical = std::sqrt(vertical_squares_ / n);
    r.mean_lateral_force = impulse_ / seconds;
    r.rms_lateral_force = lever.lateral_stiffness * std::sqrt(lateral_squares_ / n);
    r.mean_normal_force = lever.stiffness * r.mean_vertical;
    r.impact_count = impact_count_;
    r.energy_loss = energy_loss_;
    const bool has_speed = same_speed_ && since_.drag_velocity != 0.0;
    const double v0 = has_speed ? since_.drag_velocity : std::numeric_limits<double>::quiet_NaN();
    r.k_f = r.energy_loss / (v0 * v0 * seconds);
    r.k_f_work = r.mean_lateral_force / v0;
    return r;
  }

 private:
  bool is_of_period(const std_msgs::Header& header) const {
    return last_ && header.seq >= first_ && header.seq <= *last_;
  }
  std::uint32_t batches() const { return last_ ? *last_ - first_ + 1 : 0; }

  const Applied since_;
  ModelTime begin_, end_, last_begin_;  // the latter of the last batch
  std::uint32_t first_ = 0;             // header.seq
  std::optional<std::uint32_t> last_;
  bool same_speed_ = true;
  double seconds_ = 0.0, impulse_ = 0.0;
  double vertical_ = 0.0, vertical_squares_ = 0.0, lateral_squares_ = 0.0;
  std::uint64_t samples_ = 0, impact_count_ = 0;
  double energy_loss_ = 0.0;
  std::uint32_t with_impacts_ = 0, with_friction_ = 0;
};

}  // namespace afm_emulator
