// The first bounces of a sequence one by one, while they lose too much of their speed for the averages.
#include <algorithm>
#include <cmath>

#include "afm/chatter.h"
#include "chatter_bounce.h"
#include "chatter_control.h"
#include "chatter_geometry.h"
#include "portable_exp.h"

namespace afm {

// Ends where the averages hold, where contact begins, or with the last bounce before `until`. Without `exits` it ends
// at `until`, within the bounce under way: by the flow through both ends of the bounce.
ChatterRun ChatterLaw::follow_single_bounces(const SlideSegment<double>& reference, double from, double until,
                                             const Chatter& start, bool exits) const {
  Chatter c = start;
  double s = from;
  while (takes_single_bounces(c.v) && c.v > threshold_) {
    const ChatterSurroundings at = rates_.geometry().surroundings(reference, s);
    // the reaction changes by its relative rate, or swings at twice the rate of the horizontal spring
    const double far = ChatterControl::kSingleStep / std::max(at.relative_rate, 2.0 * kTwoPi * at.slow_rate);
    double t = 0.0;
    do {
      const auto r = later(at, t);
      const auto arc = arc_of(r, at, c.v);
      const double after = speed_after(max_loss_, rates_.flow(), arc.speed);
      const double part = (until - (s + t)) / arc.duration;
      if (!(part >= 1.0)) {
        if (exits) return {s + t > from ? ChatterEnd::time : ChatterEnd::exits, s + t, c};
        Chatter between = moved(at, r, part * arc.duration, rates_.flow().is_held_along_x, c);
        between.v = std::fma(part, after - c.v, c.v);
        if (after > 0.0) between.n += portable_log(between.v / c.v) / portable_log(after / c.v);
        return {ChatterEnd::time, until, between};
      }
      c = moved(at, r, arc.duration, rates_.flow().is_held_along_x, c);
      c.v = after, c.n += 1.0;
      t += arc.duration;
    } while (takes_single_bounces(c.v) && c.v > threshold_ && t < far);
    s += t;
  }
  return {c.v > threshold_ ? ChatterEnd::time : ChatterEnd::died, s, c};
}

}  // namespace afm
