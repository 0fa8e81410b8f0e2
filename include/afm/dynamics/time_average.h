// Friction as a time average along one orbit, with its error. Natural units.
#pragma once

#include <cstdint>

#include "afm/tip.h"

namespace afm {

// `K_f` +- 1.96 `K_f_std_error` holds the average over infinite time 95 times in 100, and so for `K_f_work`.
struct FrictionAverage {
  double K_f = 0.0;  // [m/tau]; NaN at eta = 0
  double K_f_std_error = 0.0;
  double impacts_per_tau = 0.0;   // the bounces of bursts counted
  double mean_energy_loss = 0.0;  // of an impact [m a^2/tau^2]; NaN without impacts
  double mean_flight_time = 0.0;  // time not in contact over impacts [tau]; NaN without impacts
  std::uint64_t search_failures = 0;
  double K_f_work = 0.0;  // from the work of the drag, the definition (Eq. 1) [m/tau]; with a bath not the same
  double K_f_work_std_error = 0.0;
};

// Over `duration` from now on, for an orbit that wanders: the error from batch means (batch_means.h).
FrictionAverage average_over_time(Tip& tip, double duration);

// For an orbit that repeats itself whenever the holder has passed `cells` cells: over the second half of the whole
// periods in `duration`, exact but for rounding and the transient; the error is what the first half differs by.
// Precondition: eta is not 0. Where fewer than two periods fit in the duration, two are taken.
FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration);

}  // namespace afm
