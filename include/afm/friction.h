// Friction from impacts (Eq. 6-8 of the paper): f = sum dE / (v0 T) and K_f = f / v0, running and over a window, with
// standard errors. Also friction by its definition (Eq. 1): the mean lateral force, whose product with v0 is the power
// of the drag. With a heat bath the two differ by the heat that the bath takes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "segment.h"
#include "state.h"

namespace afm {

// NaN: a figure is not defined (K_f at v0 = 0, errors with too few bins).
struct FrictionEstimate {
  double force = 0.0;  // [m a / tau^2], sign of the drag velocity
  double force_std_error = 0.0;
  double K_f = 0.0;  // [m_tip/tau]
  double K_f_std_error = 0.0;
  double energy_loss = 0.0;  // since the last change of drag velocity [m a^2 / tau^2]
  std::uint64_t impact_count = 0;
  double window_force = 0.0;  // over the sliding window
  double window_K_f = 0.0;
  double window_K_f_std_error = 0.0;
  double mean_lateral_force = 0.0;  // of the holder on the tip, exact over the time since the last change [m a / tau^2]
  // Too large in short runs, because the tip carries momentum across the ends of the bins. At eta = 3.4 it is 2.5 times
  // too large after 1000 tau, and 1.2 times after 10000 (test friction).
  double mean_lateral_force_std_error = 0.0;
  double K_f_work = 0.0;  // from the work of the drag, mean_lateral_force / eta: the definition (Eq. 1) [m_tip/tau]
  double K_f_work_std_error = 0.0;
  double heat_to_bath = 0.0;  // since the last change of drag velocity [m a^2/tau^2]
};

// Energy or impulse in equal bins of time. Full bins merge in pairs, so a run of any length fits. The scatter of the
// bins gives the standard error of the mean rate (batch means).
class RateBins {
 public:
  static constexpr std::size_t kBins = 64;  // a choice: at least 32 after a merge, the error's own error is 13 % then

  explicit RateBins(double bin_width) : width_(bin_width) {}
  void add(double age, double amount);  // age: time since the start [tau], never decreasing by more than a bin
  void spread(double begin, double end, double amount);  // evenly over [begin, end]; the next call begins at `end`
  double std_error(double age) const;  // of the amount per tau, from the bins completed at `age`; NaN with fewer than 8
  double width() const { return width_; }

 private:
  void merge();
  std::array<double, kBins> amount_{};
  double width_;
};

// The energy of the last `window` tau, in a ring of bins.
class PowerWindow {
 public:
  static constexpr std::size_t kWindowBins = 32;  // a choice: the window moves on in steps of 3 %

  explicit PowerWindow(double window) : width_(window / static_cast<double>(kWindowBins)) {}
  void add(double age, double energy);
  double mean(double age);       // energy per tau over the completed bins of the window; NaN before the first
  double std_error(double age);  // NaN below 8 bins
  double width() const { return width_; }
  std::int64_t current() const { return current_; }

 private:
  void roll_to(double age);
  std::size_t completed() const;
  std::array<double, kWindowBins + 1> energy_{};  // one more than the window: the bin being filled
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

  // A new drag velocity: the whole estimate restarts at `now`.
  void restart(const ModelTime& now, double eta);
  void set_window(const ModelTime& now, double window_tau);  // the window alone restarts at `now`
  void add(const Segment& segment);                          // segments since restart(), in order
  // `open`: the segment under way. It counts for the mean lateral force only.
  FrictionEstimate estimate(const ModelTime& now, const Segment& open);
  ModelTime start() const { return start_; }

  // Whether an estimate that was read from elsewhere is possible at `now`.
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
