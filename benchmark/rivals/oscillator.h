// The model as a user of a rival method writes it: four first-order equations in the comoving frame, a surface, a law
// of reflection. Plain doubles and the C library; nothing of the core but its parameters and its record of a state.
#pragma once

#include <array>
#include <cmath>

#include "afm/model.h"
#include "afm/state.h"

namespace afm::rivals {

using Point = std::array<double, 4>;  // X = x - xc, U = u - eta, Y = y - y0, W = w

// The motion after one start: the phase of the surface under the tip is c + eta s + X.
struct Oscillator {
  Oscillator(const Model& m, double eta_, const TipState& start)
      : model(m),
        eta(eta_),
        wv2(kTwoPi * kTwoPi),
        wh2(wv2 * m.frequency_ratio * m.frequency_ratio),
        c(start.phase - start.X),
        on_surface(!(start.g > 0.0)) {
    const double height = m.H * std::cos(kTwoPi * start.phase), h1 = slope(start.phase);
    begin = {start.X, start.u - eta, height + start.g - m.y0, start.g1 + h1 * start.u};
    begin_rate = start.g1;
  }

  Point rate(const Point& p) const { return {p[1], -wh2 * p[0], p[3], -wv2 * p[2]}; }
  double phase(const Point& p, double s) const { return c + eta * s + p[0]; }
  double height(double x) const { return model.H * std::cos(kTwoPi * x); }
  double slope(double x) const { return -kTwoPi * model.H * std::sin(kTwoPi * x); }
  double curvature(double x) const { return -kTwoPi * kTwoPi * height(x); }
  double gap(const Point& p, double s) const { return p[2] + model.y0 - height(phase(p, s)); }
  double gap_rate(const Point& p, double s) const { return p[3] - slope(phase(p, s)) * (eta + p[1]); }
  double gap_acceleration(const Point& p, double s) const {
    const double x = phase(p, s), u = eta + p[1];
    return -wv2 * p[2] - curvature(x) * u * u + slope(x) * wh2 * p[0];
  }

  // The time at which a parabola through the start has its top: no method need look for an impact before it, and one
  // that does finds the impact just left.
  double first_look(double longest) const {
    if (!on_surface) return 0.0;
    const double g2 = gap_acceleration(begin, 0.0);
    if (!(g2 < 0.0)) return longest;
    return std::fmin(longest, std::fmax(0.0, -begin_rate / g2));
  }

  TipState tip_state(const Point& p, double s) const {
    const double x = phase(p, s);
    return {x - std::floor(x), p[0], eta + p[1], gap(p, s), gap_rate(p, s)};
  }

  Model model;
  double eta, wv2, wh2, c;
  bool on_surface;
  Point begin;
  double begin_rate;  // of the gap
};

}  // namespace afm::rivals
