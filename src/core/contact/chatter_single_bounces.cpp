// The bounces of chatter_bounce.h, one by one, at the beginning of a burst.
#include <algorithm>
#include <cmath>

#include "afm/chatter.h"
#include "afm/detail/multiversion.h"
#include "chatter_bounce.h"
#include "chatter_flow.h"
#include "portable_exp.h"

namespace afm {

// Down to where the averages hold, or contact; to the last bounce that ends before `until`, or, of the one under way
// then, to where the flow through them has come.
AFM_MULTIVERSION ChatterRun ChatterLaw::follow_single_bounces(const SlideSegment<double>& reference, double from, double until,
                                                const Chatter& start, bool exits) const {
  // Parts of the time in which the pressure changes, or swings at twice the rate of the horizontal spring: then it is
  // looked at again.
  constexpr double kFar = 0.15;
  Chatter c = start;
  double s = from;
  while (takes_single_bounces(c.v) && c.v > threshold_) {
    const ChatterSurroundings at = rates_.surroundings(reference, s);
    const double far = kFar / std::max(at.relative_rate, 2.0 * kTwoPi * at.slow_rate);
    double t = 0.0;
    do {
      const auto r = later(at, t);
      const auto arc = arc_of(r, at, c.v);
      const double after = speed_after(most_loss_, rates_.flow(), arc.speed);
      const double part = (until - (s + t)) / arc.duration;
      if (!(part >= 1.0)) {
        if (exits) return {s + t > from ? ChatterEnd::time : ChatterEnd::exits, s + t, c};
        Chatter between = moved(at, r, part * arc.duration, rates_.held(), c);
        between.v = std::fma(part, after - c.v, c.v);
        if (after > 0.0) between.n += portable_log(between.v / c.v) / portable_log(after / c.v);
        return {ChatterEnd::time, until, between};
      }
      c = moved(at, r, arc.duration, rates_.held(), c);
      c.v = after, c.n += 1.0;
      t += arc.duration;
    } while (takes_single_bounces(c.v) && c.v > threshold_ && t < far);
    s += t;
  }
  return {c.v > threshold_ ? ChatterEnd::time : ChatterEnd::died, s, c};
}

}  // namespace afm
