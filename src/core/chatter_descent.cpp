// Bounces that lose too large a part of their speed for the averages, at the beginning of a burst: above the cutoff, or
// not far below it. There are few of them, so they are made one by one, but along the guide and without a search: the
// series of a bounce under rho'' = -P(t) - K(t) rho is all there is to it.
#include <algorithm>
#include <cmath>

#include "afm_emulator/chatter.h"
#include "afm_emulator/multiversion.h"
#include "chatter_flow.h"
#include "portable_exp.h"

namespace afm {
namespace {

using std::fma;

// The reaction so much later than at a look, and its time derivatives over it.
struct Reaction {
  double P, per_P, p1, p2, p3;
};

AFM_INLINED Reaction later(const ChatterSurroundings& at, double t) {
  const double P = fma(t, fma(t, fma(t, at.P3 * (1.0 / 6), 0.5 * at.P2), at.P1), at.P), per_P = 1.0 / P;
  return {P, per_P, fma(t, fma(t, 0.5 * at.P3, at.P2), at.P1) * per_P, fma(t, at.P3, at.P2) * per_P, at.P3 * per_P};
}

// Of a bounce that is launched at v: how long it lasts, and at what speed it ends, to the third order of q = 2 v/P.
struct Arc {
  double duration, speed;
};

AFM_INLINED Arc arc_of(const Reaction& r, const ChatterSurroundings& at, double v) {
  const double q = 2.0 * v * r.per_P, p1 = r.p1, p2 = r.p2, p1_2 = p1 * p1, K = at.bend;
  const double longer2 = fma(8.0, p1_2, -3.0 * (p2 + K)) * (1.0 / 36), longer1 = -kThird * p1;
  const double longer3 = -(fma(18.0, at.bend1, p1 * fma(100.0, p1_2, fma(-75.0, p2, -54.0 * K))) + 9.0 * r.p3) / 540.0;
  const double faster2 = fma(-2.0 / 9, p1_2, p2 * (1.0 / 6));
  const double faster3 =
      fma(p1, fma(5.0 / 27, p1_2, fma(-2.0 / 9, p2, -0.05 * K)), fma(1.0 / 60, at.bend1, 0.05 * r.p3));
  return {q * fma(q, fma(q, fma(q, longer3, longer2), longer1), 1.0),
          v * fma(q, fma(q, fma(q, faster3, faster2), kThird * p1), 1.0)};
}

// What the mean height v^2/(3 P) of a bounce moves the tip off its guide by.
AFM_INLINED Chatter moved(const ChatterSurroundings& at, const Reaction& r, double dt, bool held, const Chatter& c) {
  const double height = kThird * c.v * c.v * r.per_P * dt, P1 = r.p1 * r.P;
  const double p = fma(at.lean, height, fma(-at.stiffness * c.sigma, dt, c.p));
  return {c.v,
          c.n,
          fma(2.0 * at.turn, height, fma(0.5 * (c.p + p), dt, c.sigma)),
          p,
          fma(at.up, height, fma(at.along * c.sigma, dt, c.drift)),
          held ? fma(P1, height, c.lift) : c.lift};
}

}  // namespace

// Down to where the averages hold, or contact; to the last bounce that ends before `until`, or, of the one under way
// then, to where the flow through them has come.
AFM_MULTIVERSION ChatterRun ChatterLaw::descend(const SlidePiece<double>& guide, double from, double until,
                                                const Chatter& start, bool exits) const {
  // Parts of the time in which the pressure changes, or swings at twice the rate of the horizontal spring: then it is
  // looked at again.
  constexpr double kFar = 0.15;
  Chatter c = start;
  double s = from;
  while (descends(c.v) && c.v > threshold_) {
    const ChatterSurroundings at = rates_.surroundings(guide, s);
    const double far = kFar / std::max(at.quickness, 2.0 * kTwoPi * at.slow_rate);
    double t = 0.0;
    do {
      const Reaction r = later(at, t);
      const Arc arc = arc_of(r, at, c.v);
      const double after = arc.speed * (1.0 - std::min(most_loss_, rates_.loss(arc.speed)));
      const double part = (until - (s + t)) / arc.duration;
      if (!(part >= 1.0)) {
        if (exits) return {s + t > from ? ChatterEnd::time : ChatterEnd::exits, s + t, c};
        Chatter between = moved(at, r, part * arc.duration, rates_.held(), c);
        between.v = fma(part, after - c.v, c.v);
        if (after > 0.0) between.n += portable_log(between.v / c.v) / portable_log(after / c.v);
        return {ChatterEnd::time, until, between};
      }
      c = moved(at, r, arc.duration, rates_.held(), c);
      c.v = after, c.n += 1.0;
      t += arc.duration;
    } while (descends(c.v) && c.v > threshold_ && t < far);
    s += t;
  }
  return {c.v > threshold_ ? ChatterEnd::time : ChatterEnd::died, s, c};
}

}  // namespace afm
