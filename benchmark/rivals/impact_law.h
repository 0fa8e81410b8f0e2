// What the event methods share: the reflection by the lab velocity, and the crossing of zero, bracketed and solved.
#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "method.h"
#include "oscillator.h"

namespace afm::rivals {

inline double restitution(const Model& m, double normal_speed) {
  return normal_speed >= m.v_c ? m.gamma : 1.0 - (1.0 - m.gamma) * normal_speed / m.v_c;
}

// v' = v - (1 + e) n (n.v), on the surface at the phase of p.
inline Hit reflect(const Oscillator& o, const Point& p, double s) {
  const double x = o.phase(p, s), h1 = o.slope(x), n2 = 1.0 + h1 * h1, u = o.eta + p[1];
  const double rate = std::fmin(p[3] - h1 * u, 0.0), speed = -rate / std::sqrt(n2);
  const double e = restitution(o.model, speed);
  return {Hit::impact,
          s,
          {x - std::floor(x), p[0], u + (1.0 + e) * h1 * rate / n2, 0.0, -e * rate},
          0.5 * (1.0 - e * e) * speed * speed};
}

// The gap at one time, and its rate where a method looks for minima.
struct GapRate {
  double gap, rate = 0.0;
};

template <class Function>
double solve_bracketed(const Function& f, double low, double high, double at_low, double at_high) {
  if (at_high == 0.0) return high;
  boost::uintmax_t most = 100;
  const auto root = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                      boost::math::tools::eps_tolerance<double>(52), most);
  return 0.5 * (root.first + root.second);
}

// Looks for the first fall of a gap through zero, span by span, at a spacing of at most `grid`.
class CrossingWatch {
 public:
  CrossingWatch(const Oscillator& o, double grid) : from_(o.first_look(grid)), grid_(grid), first_(o.on_surface) {}

  // In [t0, t1], by `at`, which gives gap and rate; negative where there is none. Spans follow each other. Where the
  // rate changes from falling to rising in a span, the minimum between the samples is found first, and the root before
  // it if the gap is negative there.
  template <class At>
  double look(const At& at, double t0, double t1) {
    const auto gap = [&at](double s) { return at(s).gap; };
    double low = std::fmax(t0, from_);
    if (low >= t1) return -1.0;
    GapRate at_low = at(low);
    // where the flight is shorter than its parabola: back until the gap is positive
    for (int i = 0; first_ && at_low.gap <= 0.0 && i < 60; ++i) at_low = at(low = t0 + 0.5 * (low - t0));
    first_ = false;
    if (at_low.gap <= 0.0) return low;
    while (low < t1) {
      const double high = std::fmin(t1, low + grid_);
      const GapRate at_high = at(high);
      if (at_high.gap <= 0.0) return solve_bracketed(gap, low, high, at_low.gap, at_high.gap);
      if (at_low.rate < 0.0 && at_high.rate > 0.0) {
        const auto rate = [&at](double s) { return at(s).rate; };
        const double least = solve_bracketed(rate, low, high, at_low.rate, at_high.rate), at_least = gap(least);
        if (at_least <= 0.0) return solve_bracketed(gap, low, least, at_low.gap, at_least);
      }
      low = high;
      at_low = at_high;
    }
    return -1.0;
  }

 private:
  double from_, grid_;
  bool first_;
};

// How close together a careful user looks at the gap [tau]: an eighth of a turn of the horizontal spring, and a tenth
// of the time in which the drag passes a cell.
inline double grid(const Oscillator& o) { return std::fmin(0.02, 0.1 / std::fabs(o.eta)); }

}  // namespace afm::rivals
