// Starts of flights, as impacts leave them: on the surface, moving away. Any speed from a micro-bounce to a leap.
#pragma once

#include <cmath>
#include <random>

#include "afm/state.h"

namespace afm {

class RandomLaunches {
 public:
  explicit RandomLaunches(unsigned seed) : random_(seed) {}

  // a gap rate of 10^decades(from, to)
  TipState next(double eta, double from = -6.0, double to = 1.0) {
    const double g1 = power(from, to);
    return {within(0.0, 1.0), within(-0.1, 0.1), eta + within(-1.0, 1.0) * (1.0 + 0.5 * std::abs(eta)), 0.0, g1};
  }
  double power(double from, double to) { return std::pow(10.0, within(from, to)); }
  double sign() { return within(0.0, 1.0) < 0.5 ? -1.0 : 1.0; }
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937_64 random_;
};

}  // namespace afm
