// Chatter for tests: a bounce on a pressed slide, and every bounce that follows, one by one.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/tip.h"
#include "slides.h"

namespace afm {

struct RandomChatter {
  Model model;
  double v;  // normal speed after the first bounce
  detail::SlideSegment<double> reference;

  Tip every_bounce() const { return {model, reference.eta(), detail::leave_surface(model, reference.start(), v), 0.0}; }

  // How long a bounce is, at most, against every change around it.
  double shortness(double s) const {
    const double a = reference.pressure(s);
    return 2.0 * v / a *
           std::max({std::abs(pressure_slope(reference, s)) / a, std::abs(reference.at(s).u), model.frequency_ratio});
  }
};

// One that `law` takes: a normal speed of 10^decades(from, to) under a pressure of at least 0.5.
inline RandomChatter random_chatter(const Model& model, const detail::ChatterLaw& law, RandomLaunches& random,
                                    double from, double to) {
  const SpringConstants<double> springs(model);
  for (;;) {
    const SlidePart slide = random_part(random);
    const double v = std::pow(10.0, random.within(from, to));
    const Flight<double> bounce(springs, slide.eta(), detail::leave_surface(model, slide.start(), v));
    if (slide.pressure(0.0) > 0.5 && law.holds(bounce)) return {model, v, slide};
  }
}

}  // namespace afm
