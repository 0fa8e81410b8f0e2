// The kicks of a heat bath (docs/temperature.md). Guarantee: their times and sizes are a function of the bath, the
// number of the kick, and the times at which the bath was changed.
#pragma once

#include <cstdint>

#include "bath.h"
#include "sample_grid.h"

namespace afm {

// The change of a velocity relative to the holder: v -> keep v + noise; the noise is normally distributed.
struct VelocityKick {
  double keep = 1.0;
  double noise = 0.0;  // [a/tau]

  double change(double v) const { return (keep - 1.0) * v + noise; }
};
struct Kick {
  VelocityKick lateral, vertical;
};

class Thermostat {
 public:
  Thermostat() = default;
  Thermostat(const Bath& bath, double frequency_ratio, const SampleGrid& grid, std::uint64_t count)
      : bath_(bath), grid_(grid), kicks_(count) {
    prepare(frequency_ratio);
  }

  // Another bath from `now` on. The times of kicks stay, unless their rate changes or the bath was off. Then the next
  // kick comes one period after `now`. The count of kicks goes on, so no random number is drawn twice.
  void set(const Bath& bath, double frequency_ratio, const ModelTime& now);

  const ModelTime& next() const { return next_; }  // kEndOfTime without a bath
  const Bath& bath() const { return bath_; }
  const SampleGrid& grid() const { return grid_; }  // kick n comes at its n-th time
  std::uint64_t count() const { return kicks_; }    // so far

  double noise() const { return scale_.vertical.noise; }  // standard deviation of a vertical kick [a/tau]
  Kick draw();                                            // takes the next kick

 private:
  void prepare(double frequency_ratio);

  Bath bath_;
  SampleGrid grid_{1.0, 0, {}};
  std::uint64_t kicks_ = 0;
  ModelTime next_ = kEndOfTime;
  Kick scale_;  // its noise holds the standard deviations
};

}  // namespace afm
