// The Boltzmann distribution of mica's tip at rest: density proportional to exp(-energy/theta) above the surface.
#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>

#include "afm/model.h"
#include "afm/surface.h"

namespace afm {

// Averages over it for a holder at xc. Velocities are normal, of variance theta.
class Boltzmann {
 public:
  Boltzmann(double theta, double xc)
      : xc_(xc), s_X_(std::sqrt(theta) / (kTwoPi * Model{}.frequency_ratio)), s_Y_(std::sqrt(theta) / kTwoPi) {}

  // Of a function of X times what the vertical direction gives: partial(a), a the height of the surface in widths.
  double over_X(const std::function<double(double)>& of_X, const std::function<double(double)>& of_height) const {
    const auto weighted = [&](double t) {
      const double X = t * s_X_, a = surface_jet(Model{}.H, xc_ + X).h / s_Y_;
      return std::exp(-0.5 * t * t) * of_X(X) * of_height(a);
    };
    double sum = 0.0;
    for (int i = -16; i < 16; ++i) {
      sum += boost::math::quadrature::gauss<double, 15>::integrate(weighted, 0.5 * i, 0.5 * (i + 1));
    }
    return sum;
  }
  static double tail(double a) { return 0.5 * std::erfc(a / std::sqrt(2.0)); }
  static double density(double a) { return std::exp(-0.5 * a * a) / std::sqrt(kTwoPi); }
  static double one(double) { return 1.0; }

  double norm() const { return over_X(one, tail); }
  double mean_X() const {
    return over_X([](double X) { return X; }, tail) / norm();
  }
  double mean_X2() const {
    return over_X([](double X) { return X * X; }, tail) / norm();
  }
  double mean_Y() const { return s_Y_ * over_X(one, density) / norm(); }
  double mean_Y2() const {
    return s_Y_ * s_Y_ * over_X(one, [](double a) { return tail(a) + a * density(a); }) / norm();
  }
  double below_X(double X0) const {
    return over_X([X0](double X) { return X < X0 ? 1.0 : 0.0; }, tail) / norm();
  }
  double below_Y(double Y0) const {
    const double b = Y0 / s_Y_;
    return over_X(one, [b](double a) { return a < b ? tail(a) - tail(b) : 0.0; }) / norm();
  }

 private:
  double xc_, s_X_, s_Y_;
};

}  // namespace afm
