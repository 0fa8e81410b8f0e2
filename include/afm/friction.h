// Friction from impacts (Eq. 6-8): f = sum dE / (v0 T), K_f = f / v0, running and windowed, with standard errors; and by its
// definition (Eq. 1), the mean lateral force, whose product with v0 is the power of the drag. With a heat bath the two
// differ by the heat that the bath takes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "segment.h"
#include "state.h"

namespace afm {

// All in natural units; NaN where a figure is not defined (K_f at v0 = 0, errors before there are enough bins).
struct FrictionEstimate {
  double force = 0.0;  // [m a / tau^2], sign of the drag velocity
  double force_std_error = 0.0;
  double K_f = 0.0;  // [m / tau]
  double K_f_std_error = 0.0;
  double energy_loss = 0.0;  // since the last change of drag velocity [m a^2 / tau^2]
  std::uint64_t impact_count = 0;
  double window_force = 0.0;  // over the sliding window
  double window_K_f = 0.0;
  double window_K_f_std_error = 0.0;
  double mean_lateral_force = 0.0;  // of the holder on the tip, exact over all the time so far [m a / tau^2]
  // Too large in short runs, as bins see the momentum that the tip carries across their ends: at eta = 3.4 by 2.5 after
  // 1000 tau, by 1.2 after 10000.
  double mean_lateral_force_std_error = 0.0;
  double K_f_work = 0.0;  // from the work of the drag, mean_lateral_force / eta: the definition (Eq. 1) [m / tau]
  double K_f_work_std_error = 0.0;
  double heat_to_bath = 0.0;  // since the last change of drag velocity [m a^2/tau^2]
};

// Energy or impulse in equal bins of time. When the bins are full neighbours merge, so any run fits in the same memory,
// and the spread of the bins gives the standard error of the mean rate (batch means).
class RateBins {
 public:
  static constexpr std::size_t kBins = 64;

  explicit RateBins(double bin_width) : width_(bin_width) {}
  void add(double age, double amount);  // age: time since the start [tau], never decreasing by more than a bin
  void spread(double begin, double end, double amount);  // evenly over the ages between; the next begins at `end`
  double std_error(double age) const;  // of the amount per tau, from the bins completed at `age`; NaN below 8 bins
  double width() const { return width_; }

 private:
  void merge();
  std::array<double, kBins> amount_{};
  double width_;
};

// The last `window` tau, in a ring of bins.
class PowerWindow {
 public:
  static constexpr std::size_t kBins = 32;

  explicit PowerWindow(double window) : width_(window / static_cast<double>(kBins)) {}
  void add(double age, double energy);
  double mean(double age);       // energy per tau over the completed bins of the window; NaN before the first
  double std_error(double age);  // NaN below 8 bins
  double width() const { return width_; }
  std::int64_t current() const { return current_; }

 private:
  void roll_to(double age);
  std::size_t completed() const;
  std::array<double, kBins + 1> energy_{};  // one bin more than the window holds: the one being filled
  double width_;
  std::int64_t current_ = 0;
};

// A sum whose rounding is carried along (Kahan).
class CompensatedSum {
 public:
  void add(double x);
  double value() const { return sum_; }

 private:
  double sum_ = 0.0, rest_ = 0.0;
};

class Friction {
 public:
  explicit Friction(double window_tau);

  // a new drag velocity: everything starts again at `now`
  void restart(const ModelTime& now, double eta);
  void set_window(const ModelTime& now, double window_tau);  // the window alone starts again at `now`
  void add(const Segment& segment);                          // of the motion since restart(), in order
  // `open`: the segment under way. It counts for the mean lateral force, not for the energy lost.
  FrictionEstimate estimate(const ModelTime& now, const Segment& open);
  ModelTime start() const { return start_; }

  // Of one that was read somewhere: whether it can have come to be at `now`.
  bool is_possible(const ModelTime& now, double window_tau) const;

 private:
  double window_tau_;
  ModelTime start_, window_start_;
  double eta_ = 0.0;
  CompensatedSum energy_, impulse_, heat_;
  std::uint64_t impact_count_ = 0;
  RateBins energy_bins_, impulse_bins_;
  PowerWindow window_;
};

}  // namespace afm
