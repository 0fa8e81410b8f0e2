// Friction as a time average along one orbit, with its error (Eq. 1 and 6-8 of the paper). Natural units.
#pragma once

#include <cstdint>

#include "afm/tip.h"

namespace afm {

// K_f +- 1.96 K_f_std_error holds the average over infinite time 95 times in 100, and so does K_f_work without a bath.
// With a bath K_f_work_std_error also holds the energy stored at the ends of batches: it is an upper bound. A tip that
// cannot go on (Outcome::search_failed) has no averages: all are NaN.
struct FrictionAverage {
  double K_f = 0.0;  // [m_tip/tau]; NaN at eta = 0
  double K_f_std_error = 0.0;
  double impacts_per_tau = 0.0;       // every bounce of a chatter sequence counts
  double mean_energy_loss = 0.0;      // per impact [m_tip a^2/tau^2]; NaN without impacts
  double mean_flight_time = 0.0;      // time out of contact per impact [tau]; NaN without impacts
  std::uint64_t search_failures = 0;  // Tip::search_failures() in this time
  // By definition (Eq. 1), from the work of the drag [m_tip/tau]; with a bath it differs from K_f.
  double K_f_work = 0.0;
  double K_f_work_std_error = 0.0;
};

// Over `duration` [tau] from now on, for an orbit that is not periodic. The error comes from batch means
// (batch_means.h).
FrictionAverage average_over_time(Tip& tip, double duration);

// For a periodic orbit: the second half of the whole periods in `duration`, at least one period. Exact except for
// rounding and a transient; the error is the difference from the first half. Precondition: the orbit repeats after the
// holder has passed `cells` cells, and eta is not 0. With 0 cells, of an orbit that is not periodic, it is
// average_over_time().
FrictionAverage average_over_periods(Tip& tip, std::int64_t cells, double duration);

}  // namespace afm
