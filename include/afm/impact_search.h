// The first time after the start of a flight at which the gap is 0 and falling. No root is ever passed: every step is
// bounded by the third derivative of the gap, and a root is finished only inside an interval where it is certified to
// be the only one.
#pragma once

#include "flight.h"
#include "afm/detail/impact_steps.h"
#include "afm/detail/near_root.h"

namespace afm {

enum class SearchOutcome {
  impact,     // found: `s` and `jet` are at the root
  clear,      // certified free of impacts up to `s`: the horizon, or as far as many looks have come
  undecided,  // a graze or a root that rounding hides; certified free up to `s`. More digits decide it
  cap         // too many steps; certified free up to `s`
};

template <class T>
struct Landing {
  SearchOutcome outcome;
  T s;
  GapJet<T> jet;    // incident state at `s`; g is what rounding left
  int evaluations;  // of the gap
};

constexpr int kMaxSearchSteps = 20000;
// A flight without an impact is searched this far and then begun anew from there [tau].
constexpr double kSearchHorizon = kFarthestRoot;

namespace search_detail {

// As far as a step reaches forwards it reaches backwards too, if the gap does not shrink.
constexpr double kAhead = 0.8;

// Where to look first below the crest: the tip has that far to fall at least in most flights.
template <class T>
T descent(const Flight<T>& f, const T& reach) {
  using std::min;
  const Mechanics<T>& m = f.mechanics();
  return min(T(kAhead) * reach, T(0.46) * m.H / (m.omega_v * f.amplitude_Y()));
}

// The root of g1 + g2 t/2 + g3 t^2/6 + g4 t^3/24 near that of the first two, by its series.
template <class T>
T end_of_bounce(const Flight<T>& f) {
  const GapJet<T>& o = f.start();
  const T per = T(1.0) / o.g2, t = T(-2.0) * o.g1 * per, g4 = fourth_derivative(f, o, T(f.launch().u));
  const T a = (over(o.g3, 3.0) * per) * t, b = g4 * (over(per, 12.0) * (t * t)), one(1.0), two(2.0), five(5.0);
  const T sum = mul_add(b, mul_add(five, a, T(-one)), mul_add(a, mul_add(two, a, T(-one)), one));
  return mul_add(t, sum, T((T(-five) * a * t) * (a * a)));
}

// A bounce so brief that its third derivative, times its length, is at most this part e of its acceleration: the gap is
// concave until well past its root (e (1 + e) < 1), which lies within the same part of the parabola's ((1 + e)^2 < 3),
// and there it falls (e <= 0.36). So there is one, and nothing is left to be certified.
constexpr double kBrief = 0.3;

template <class T>
T parabola_length(const Flight<T>& f) {
  return T(-2.0) * f.start().g1 / f.start().g2;
}

// Precondition: it starts on the surface.
template <class T>
Truth<T> is_brief(const Flight<T>& f, const T& length) {
  using std::abs;
  const T pull = T(-kBrief) * f.start().g2, most = T(1.0 + kBrief) * length, third = abs(f.start().g3);
  const auto fine = [&] { return (third + f.early_fourth_derivative_bound(most) * most) * most < pull; };
  return length > T(0.0) && f.start().g1 > T(0.0) && f.is_small(most) && both(third * most < pull, fine);
}

// Leaves the surface: certified up to s; where to look next, and how far a step may reach.
template <class T>
void take_off(const Flight<T>& f, T& s, T& ahead, T& guess) {
  using std::max;
  const T quickly = leave_quickly(f), slowly = leave_slowly(f, quickly), first = max(quickly, slowly);
  const T aloft = time_aloft(f, first);
  s = select(aloft > first, aloft, first);
  const auto low = [&] {
    // where the parabola's own root was nearest, it is the impact
    return either(
        f.start().g2 * first < T(-1.6) * f.start().g1 && !(slowly > quickly),
        [&] { return T(max(T(0.0), T(end_of_bounce(f) - first))); }, [&] { return T(T(kAhead) * first); });
  };
  ahead = either(
      aloft > first, [&] { return descent(f, first); }, low);
  guess = T(2.0) * first;
}

// A step of the fourth order from here ends within an ulp of the time: nothing is left to look at there. What the
// series leaves out, 14 a2^4 - 21 a2^2 a3 + 3 a3^2 + 6 a2 a4 and the fifth derivative, is smaller.
template <class T>
Truth<T> settles(const Flight<T>& f, const NearJet<T>& near, const T& step, const T& time) {
  using std::abs;
  using std::max;
  const GapJet<T>& jet = near.jet;
  // where the series is worth nothing its sum may be small by chance: its first term is not
  const T per = abs(near.per_g1), reach = max(abs(step), T(abs(jet.g) * per)), t2 = reach * reach;
  const T a = abs(jet.g2) * reach * (per / T(2.0)), b = abs(jet.g3) * t2 * over(per, 6.0);
  const T c = abs(near.g4) * reach * t2 * over(per, 24.0),
          rest = f.fifth_derivative_bound() * (t2 * t2) * over(per, 120.0);
  const T square = a * a + b, left_out = T(14.0) * square * square + T(6.0) * a * c + rest;
  return left_out * reach < epsilon<T>() * time / T(64.0);
}

// What a drift of so far leaves out is well below an ulp of the velocities: it always adds energy.
template <class T>
Truth<T> is_smooth(const Flight<T>& f, const GapJet<T>& jet, const T& step) {
  using std::abs;
  const T t2 = step * step;
  return f.fifth_derivative_bound() * (t2 * t2) <= epsilon<T>() * abs(jet.g1);
}

// The same for a certified root about `jet`. It is the step that counts, not the estimate: where a spring turns within
// the root's interval the series behind either is worth nothing.
template <class T>
Truth<T> is_there(const Flight<T>& f, const GapJet<T>& jet, const RootInterval<T>& root, const T& time) {
  const NearJet<T> near(f, jet);
  const T step = root_step(near);
  return settles(f, near, step, time) && root.low <= step && step <= root.high;
}

// The gap falls on all of the root's interval. Where it seems not to, or no step gets to the root, rounding hides it.
template <class T>
Landing<T> hidden_root(const Flight<T>& f, const T& s, const RootInterval<T>& root, int evaluations) {
  const T before = root.low < T(0.0) ? T(s + root.low) : s;
  return {SearchOutcome::undecided, before, f.gap(before), evaluations};
}

// Where the way to a certified root begins: at a look away from it or near enough, or at the launch of a brief bounce.
enum class Beginning { away, there, brief };

// Finishes the certified root about `jet`, of time s. Steps of the fourth order within the root's interval, which each
// look makes smaller; by halves where they would leave it. At the end of a brief bounce the first is mostly short.
template <class T>
Landing<T> finish(const Flight<T>& f, const T& s, GapJet<T> jet, const RootInterval<T>& root, Beginning beginning,
                  int evaluations) {
  using std::abs;
  constexpr int kMaxFinish = 60;
  T t = T(0.0), step = root.estimate, low = root.low, high = root.high;
  for (int i = 0; i < kMaxFinish; ++i) {
    const bool there = i == 0 && beginning == Beginning::there;
    if (!there) {
      jet = f.gap_near(jet, s + t, step);
      t = t + step;
      ++evaluations;
      if (!(jet.g1 < T(0.0))) return hidden_root(f, s, root, evaluations);
    }
    const NearJet<T> near(f, jet);
    if (i == 0 && beginning == Beginning::brief) {
      const ShortStep<T> rest = short_step(f, near, T(s + t));
      if (rest.enough && lies_within(low, T(t + rest.step), high))
        return {SearchOutcome::impact, s + (t + rest.step), short_drift(f, jet, rest.step), evaluations};
    }
    step = root_step(near);
    (jet.g > T(0.0) ? low : high) = t;
    if (!lies_within(low, T(t + step), high)) step = (low + high) / T(2.0) - t;  // also where it is no number
    const bool settled = there || settles(f, near, step, T(s + t));
    const bool hidden = abs(step * jet.g1) <= f.gap_error(s + t);  // by the rounding of the gap
    // move the evaluated state instead of evaluating again
    if (hidden || (settled && is_smooth(f, jet, step)))
      return {SearchOutcome::impact, s + (t + step), drift(f, near, step), evaluations};
    if (settled) return {SearchOutcome::impact, s + (t + step), f.gap_near(jet, s + t, step), evaluations + 1};
  }
  return hidden_root(f, s, root, evaluations);
}

template <class T>
Landing<T> finish(const Flight<T>& f, const T& s, const GapJet<T>& jet, const RootInterval<T>& root, int evaluations) {
  const Beginning beginning = is_there(f, jet, root, s) ? Beginning::there : Beginning::away;
  return finish(f, s, jet, root, beginning, evaluations);
}

// The end of one that is brief: near where its series ends.
template <class T>
RootInterval<T> brief_root(const Flight<T>& f, const T& length) {
  return {length > T(0.0), end_of_bounce(f), T(1.0 - kBrief) * length, T(1.0 + kBrief) * length};
}

// Of one that is not as brief: g/t = g1 + g2 t/2 + g3 t^2/6, give or take M t^3/24, and where its slope is below -steep
// up to `far` there is one root, within M t^3 / (24 steep) of that of the parabola. The gap falls there: its rate is
// g/t and t times that slope.
template <class T>
RootInterval<T> soon_root(const Flight<T>& f) {
  using std::abs;
  using std::max;
  using std::sqrt;
  constexpr double kRounding = 0x1p-46;  // of the parabola's own root, ample
  const GapJet<T>& o = f.start();
  const T half = o.g2 / T(2.0), sixth = over(o.g3, 6.0), fall = sqrt(mul_add(half, half, T(T(-4.0) * sixth * o.g1)));
  const T t = T(2.0) * o.g1 / (fall - half), far = T(1.25) * t, bound = f.early_fourth_derivative_bound(far);
  const T swing = bound * (far * far) * T(0.125), bend = T(2.0) * sixth * far;
  const T steep = -(half + (max(T(0.0), bend) + swing)), steepest = abs(half) + (abs(bend) + swing), t3 = t * (t * t);
  const T width = bound * over(t3, 24.0) / steep + T(kRounding) * t;
  const T estimate = t + fourth_derivative(f, o, T(f.launch().u)) * over(t3, 24.0) / fall;
  return {steep > T(0.0) && width < T(0.2) * t && T(2.0) * width * steepest < (t - width) * steep,
          clamp(estimate, T(t - width), T(t + width)), t - width, t + width};
}

// The end of a flight that is certain from how it begins, if it is.
template <class T>
RootInterval<T> root_from_launch(const Flight<T>& f) {
  constexpr double kSoon = 0.25;  // of the fastest turn: longer ones would not be certain
  const T length = parabola_length(f);
  const auto longer = [&] {
    const Truth<T> soon = length > T(0.0) && f.start().g1 > T(0.0) && length * f.bounds().fastest < T(kSoon);
    return either(
        soon, [&] { return soon_root(f); }, no_root<T>);
  };
  return either(
      is_brief(f, length), [&] { return brief_root(f, length); }, longer);
}

}  // namespace search_detail

// Searches from the start to the horizon. A flight that starts on the surface falling is an impact at once; one that
// neither rises nor is let go has no flight: contact is the tip's affair.
// The gap is evaluated `ahead` of the time `s` that is certified, as far as it is likely to certify what lies behind it
// too.
// `from`: the flight is known to be free of impacts up to there. `bound`: called before bounds of the third and fourth
// derivative are asked for.
template <class T, class Bound>
Landing<T> find_impact(const Flight<T>& f, const T& horizon, const T& from, const Bound& bound) {
  using search_detail::finish;
  using std::min;
  const bool on_surface = !(f.start().g > T(0.0)) && !(from > T(0.0));
  if (on_surface && f.start().g1 < T(0.0)) return {SearchOutcome::impact, T(0.0), f.start(), 0};
  if (on_surface) {
    const RootInterval<T> root = search_detail::root_from_launch(f);
    if (root.certain && root.high < horizon)
      return finish(f, T(0.0), f.start(), root, search_detail::Beginning::brief, 0);
  }
  bound();
  T s = from, ahead = T(0.0), guess = T(0.05);
  if (on_surface) search_detail::take_off(f, s, ahead, guess);
  for (int evaluations = 1; evaluations <= kMaxSearchSteps; ++evaluations) {
    if (s > horizon) s = horizon;
    if (s + ahead > horizon) ahead = horizon - s;
    const T p = s + ahead;
    const GapJet<T> jet = f.gap(p);
    const T error = f.gap_error(p);
    if (ahead > T(0.0) && !positive_behind(f, jet, error, ahead)) {
      const RootInterval<T> root = certify_root_behind(f, jet, error, ahead);
      if (root.certain) return finish(f, p, jet, root, evaluations);
      ahead = T(0.0);
      continue;
    }
    s = p;
    const RootInterval<T> root = certify_root(f, jet, error);
    if (root.certain) return finish(f, s, jet, root, evaluations);
    if (!(s < horizon)) return {SearchOutcome::clear, s, jet, evaluations};
    const T above = time_above_crest(f, jet.state);
    if (above > T(0.0)) {
      s = s + above;
      ahead = search_detail::descent(f, guess);
      continue;
    }
    const T step = safe_step(f, jet, error, guess);
    if (!(step > T(4.0) * epsilon<T>() * s)) return {SearchOutcome::undecided, s, jet, evaluations};
    guess = step * T(2.0);
    ahead = step * T(search_detail::kAhead);
    if (root.estimate > step) ahead = min(ahead, T(root.estimate - step));
    s = s + step;
  }
  return {SearchOutcome::cap, s, f.gap(s), kMaxSearchSteps};
}

template <class T>
Landing<T> find_impact(const Flight<T>& f, const T& horizon, const T& from = T(0.0)) {
  return find_impact(f, horizon, from, [] {});
}

// In double, and where rounding hides a graze or a root, on the same start in twice the digits. So an impact or a miss
// is what exact arithmetic on the given doubles says, down to 1e-30. What even they cannot tell, or too many looks, is
// a touch where no gap is left, clear so far where 0.1 tau are certified, and `cap` otherwise.
Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon);
// The same of one whose higher derivatives are bounded where they are asked for.
Landing<double> find_landing(const Model& model, Flight<double>& flight, double horizon);

}  // namespace afm
