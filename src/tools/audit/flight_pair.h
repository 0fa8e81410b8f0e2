// A flight seen at two moments: the springs turn it, so that two samples of the deflection give the whole state.
#pragma once

#include <cmath>

namespace afm::audit {

// One spring of angular frequency omega [rad/tau], at positions x1 and x2 a time h apart.
class SpringPair {
 public:
  SpringPair(double omega, double x1, double x2, double h)
      : omega_(omega), x1_(x1), x2_(x2), h_(h), per_sine_(1.0 / std::sin(omega * h)) {}

  // s: time since the first of the two
  double position(double s) const {
    return (x1_ * std::sin(omega_ * (h_ - s)) + x2_ * std::sin(omega_ * s)) * per_sine_;
  }
  double velocity(double s) const {
    return omega_ * (x2_ * std::cos(omega_ * s) - x1_ * std::cos(omega_ * (h_ - s))) * per_sine_;
  }

 private:
  double omega_, x1_, x2_, h_, per_sine_;
};

// By how much two samples that far apart amplify the rounding of positions into velocities.
inline double amplification(double omega, double h) { return 1.0 / std::abs(std::sin(omega * h)); }

}  // namespace afm::audit
