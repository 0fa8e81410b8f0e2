// Chatter for tests: a bounce on a pressed guide, and every bounce that follows, one by one.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/tip.h"
#include "slides.h"

namespace afm {

struct RandomChatter {
  Model model;
  double v;  // normal speed after the first bounce
  SlidePiece<double> guide;

  Tip every_bounce() const { return {model, guide.eta(), leave_surface(model, guide.start(), v), 0.0}; }

  // How long a bounce is, at most, against every change around it.
  double shortness(double s) const {
    const double a = guide.pressure(s);
    return 2.0 * v / a *
           std::max({std::abs(guide.pressure_rate(s)) / a, std::abs(guide.at(s).u), model.frequency_ratio});
  }
};

// One that `law` takes: a normal speed of 10^decades(from, to) under a pressure of at least 0.5.
inline RandomChatter random_chatter(const Model& model, const ChatterLaw& law, RandomLaunches& random, double from,
                                    double to) {
  const Mechanics<double> mechanics(model);
  for (;;) {
    const Piece guide = random_piece(random);
    const double v = std::pow(10.0, random.within(from, to));
    const Flight<double> bounce(mechanics, guide.eta(), leave_surface(model, guide.start(), v));
    if (guide.pressure(0.0) > 0.5 && law.holds(bounce)) return {model, v, guide};
  }
}

}  // namespace afm
