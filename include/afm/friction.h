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
  double force = 0.0;            // by impacts [m_tip a/tau^2], sign of the drag velocity; with a bath not the friction
  double force_std_error = 0.0;  // [m_tip a/tau^2]
  double K_f = 0.0;              // by impacts, force / eta [m_tip/tau]
  double K_f_std_error = 0.0;    // [m_tip/tau]
  double energy_loss = 0.0;      // since the last restart [m_tip a^2/tau^2]
  std::uint64_t impact_count = 0;
  double window_force = 0.0;          // by impacts over the sliding window [m_tip a/tau^2]
  double window_K_f = 0.0;            // [m_tip/tau]
  double window_K_f_std_error = 0.0;  // [m_tip/tau]
  double mean_lateral_force = 0.0;    // of the holder on the tip, exact since the last restart [m_tip a/tau^2]
  // Without a bath: that of K_f, and what the tip has stored since the last restart. With a bath: from bins of the
  // impulse, and what is stored; it is too large in short runs, because the tip carries momentum across the ends of
  // bins. At rest: from these bins.
  double mean_lateral_force_std_error = 0.0;
  double K_f_work = 0.0;  // from the work of the drag, mean_lateral_force / eta: the definition (Eq. 1) [m_tip/tau]
  double K_f_work_std_error = 0.0;
  double mean_normal_force = 0.0;  // of the holder on the tip towards the surface, mean of the samples [m_tip a/tau^2]
  double heat_to_bath = 0.0;       // since the last restart [m_tip a^2/tau^2]
};

// Energy or impulse in equal bins of time. Full bins merge in pairs, so a run of any length fits. The scatter of the
// bins gives the standard error of the mean rate (batch means).
struct RateBins {
  static constexpr std::size_t kBins = 64;  // a choice: at least 32 after a merge, the error's own error is 13 % then

  void add(double age, double part);  // age: time since the start [tau], never decreasing by more than a bin
  void spread(double begin, double end, double part);  // evenly over [begin, end]; the next call begins at `end`
  double std_error(double age) const;  // of the amount per tau, from the bins completed at `age`; NaN with fewer than 8
  // The same of `mean`, the amount per tau up to `age`: with how far this is from the mean of these bins, which alone
  // is left where a motion repeats in each bin.
  double std_error(double age, double mean) const;

  double width = 1.0;  // [tau] a vertical period at first; it doubles at every merge
  std::array<double, kBins> amount{};

 private:
  void merge();
  RateBins at(double age) const;
};

// The energy of the last `window` tau, in a ring of bins.
struct PowerWindow {
  static constexpr std::size_t kWindowBins = 32;  // a choice: the window moves on in steps of 3 %

  explicit PowerWindow(double window) : width(window / static_cast<double>(kWindowBins)) {}
  void add(double age, double part);
  double mean(double age);       // energy per tau over the completed bins of the window; NaN before the first
  double std_error(double age);  // NaN below 8 bins

  double width;                                  // [tau]
  std::array<double, kWindowBins + 1> energy{};  // one more than the window: the bin being filled
  std::int64_t current = 0;                      // number of that bin since the start

 private:
  void roll_to(double age);
  std::size_t completed() const;
};

// A sum whose rounding is carried along (Kahan).
struct CompensatedSum {
  void add(double x);

  double value = 0.0, rest = 0.0;
};

// The sums from which an estimate is computed.
struct FrictionSums {
  explicit FrictionSums(double window_length) : window_tau(window_length), window(window_length) {}

  double window_tau;
  ModelTime start, window_start;
  double eta = 0.0;
  CompensatedSum energy, impulse, heat;
  std::uint64_t impact_count = 0;
  CompensatedSum vertical;  // y - y0 of the samples [a]
  std::uint64_t samples = 0;
  RateBins energy_bins, impulse_bins;
  PowerWindow window;
};

class Friction {
 public:
  explicit Friction(double window_tau) : sums_(window_tau) {}
  explicit Friction(const FrictionSums& sums) : sums_(sums) {}

  // After a change of drag velocity, model, level or bath: the whole estimate restarts at `now`.
  void restart(const ModelTime& now, double eta);
  void set_window(const ModelTime& now, double window_tau);  // the window alone restarts at `now`
  void add(const Segment& segment);                          // segments since restart(), in order
  void add_samples(const double* vertical, std::size_t n);   // y - y0 of each [a]
  // `open`: the segment under way. It counts for the mean lateral force only.
  FrictionEstimate estimate(const ModelTime& now, const Segment& open);
  const FrictionSums& sums() const { return sums_; }

  // True if an estimate that was read from elsewhere is possible at `now`.
  bool is_possible(const ModelTime& now, double eta, double window_tau) const;

 private:
  FrictionSums sums_;
};

}  // namespace afm
