// Friction as a time average along one orbit, with its error. Natural units.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/tip.h"

namespace afm {

// `K_f` +- 1.96 `K_f_std_error` holds the average over infinite time 95 times in 100.
struct FrictionAverage {
  double K_f = 0.0;  // [m/tau]; NaN at eta = 0
  double K_f_std_error = 0.0;
  double impacts_per_tau = 0.0;   // the bounces of bursts counted
  double mean_energy_loss = 0.0;  // of an impact [m a^2/tau^2]; NaN without impacts
  double mean_flight_time = 0.0;  // time not in contact over impacts [tau]; NaN without impacts
  std::uint64_t search_failures = 0;
};

// Over `duration` from now on, for an orbit that wanders: the error from batch means (batch_means.h).
FrictionAverage average_over_time(Tip& tip, double duration);

// For an orbit that repeats itself whenever the holder has passed `cells` cells: over the second half of the whole
// periods in `duration`, exact but for rounding and the transient; the error is what the first half differs by.
// Precondition: eta is not 0. Where fewer than two periods fit in the duration, two are taken.
FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration);

// The same of a tip that someone else brings on, such as many at once (ensemble.h): to limit() time after time until it
// is done, each event on the way told in turn.
class FrictionMeter {
 public:
  // Of an orbit that repeats itself after `cells` cells, or wanders: 0. The tip is moved to where the meter begins.
  FrictionMeter(Tip& tip, std::int64_t cells, double duration);

  bool done() const { return windows_left_ == 0; }
  const ModelTime& limit() const { return end_; }
  void add(const Impact& event);
  void add_search_failures(std::uint64_t n) { books_.search_failures += n; }
  void reach_limit();                                        // the tip is there
  const FrictionAverage& average() const { return average_; }  // once done

 private:
  // A sum whose rounding is carried along (Neumaier).
  class Sum {
   public:
    void add(double x);
    double value() const { return sum_ + rest_; }

   private:
    double sum_ = 0.0, rest_ = 0.0;
  };
  struct Books {
    Sum energy;
    double impacts = 0.0, contact_time = 0.0;
    std::uint64_t search_failures = 0;
  };

  void begin_window(const ModelTime& begin);
  FrictionAverage window_average() const;

  double eta_, length_;  // of a window [tau]
  int windows_left_;
  ModelTime begin_, end_, touched_;
  bool in_contact_;
  Books books_;
  std::vector<double> batches_;  // of an orbit that wanders: energies lost
  FrictionAverage average_;
};

// Brings the tip on until the meter is done.
FrictionAverage measure(Tip& tip, FrictionMeter& meter);

}  // namespace afm
