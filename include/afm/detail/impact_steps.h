// The steps of the impact search: how far the gap is certainly positive, and where it certainly has one root.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/flight.h"

namespace afm {

// Of what is no number, `low`.
template <class T>
T clamp(const T& x, const T& low, const T& high) {
  return select(x > low, select(x < high, x, high), low);
}

template <class T>
Truth<T> lies_within(const T& low, const T& x, const T& high) {
  return low <= x && x <= high;
}

// Bounds of the third derivative over the next S, or the last, sharp enough for g >= g + g1 t + g2 t^2/2 + low t^3/6 on
// all of [0, S], and likewise from above for gap and gap rate: from what it is now and the fourth derivative, or from
// its own bound.
template <class T>
struct ThirdDerivative {
  T low, high;
};

template <class T>
ThirdDerivative<T> third_derivative_over(const Flight<T>& f, const GapJet<T>& jet, const T& S) {
  using std::max;
  using std::min;
  const T bound3 = f.third_derivative_bound(jet, S), change = f.fourth_derivative_bound(jet, S) * S;
  return {max(T(-bound3), T(jet.g3 - change * T(0.25))), min(bound3, T(jet.g3 + over(change, 3.0)))};
}

// The fourth derivative of the gap; u: the velocity there, where it is known.
template <class T>
T fourth_derivative(const Flight<T>& f, const GapJet<T>& jet, const T& u) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T x2 = -wh2 * q.X, x3 = -wh2 * q.U, v2 = k2 * u * u;
  const T bend = mul_add(T(-v2), v2, T(k2 * mul_add(T(T(3.0) * x2), x2, T(T(4.0) * u * x3))));
  return mul_add(jet.h, bend, mul_add(T(jet.h1 * x2), mul_add(T(6.0), v2, wh2), T(wv2 * wv2 * q.Y)));
}
template <class T>
T fourth_derivative(const Flight<T>& f, const GapJet<T>& jet) {
  return fourth_derivative(f, jet, T(f.eta() + jet.state.U));
}

// Leaving the surface: g = g1 s + g2 s^2/2 - bound3 s^3/6 at least, positive up to its first root. A little less than
// that, so that a bounce whose root it nearly is still has a gap to be seen, and the root is near. Where gap rate and
// acceleration are nothing, as at the end of a slide, the third derivative decides: g3 s^3/6 - bound4 s^4/24.
template <class T>
T leave_quickly(const Flight<T>& f) {
  using std::max;
  using std::sqrt;
  const T g1 = f.start().g1, b = f.start().g2 / T(2.0), a = over(f.third_derivative_bound(), 6.0);
  const T root = sqrt(mul_add(T(T(4.0) * a), g1, T(b * b)));
  const T first = T(0.999) * choose(
                                 b > T(0.0), [&] { return T((b + root) / (a * T(2.0))); },
                                 [&] { return T(T(2.0) * g1 / (root - b)); });
  return either(
      g1 > T(0.0) || b < T(-kReleaseNoise), [&] { return first; },
      [&] {
        return T(max(select(b > T(0.0), first, T(0.0)), T(T(3.0) * f.start().g3 / f.fourth_derivative_bound())));
      });
}

// The same where hardly a turn of the fastest is free by that: at the end of a dwell gap rate and acceleration are next
// to nothing, and the third derivative takes the tip up. For as long as a part of it is left, half or what it takes for
// g1 s + g2 s^2/2 + part g3 s^3/6 to have no root, and at most a part of a turn; otherwise 0.
template <class T>
T leave_slowly(const Flight<T>& f) {
  using std::abs;
  using std::max;
  using std::min;
  constexpr double kSoon = 0x1p-3, kMostPart = 0.9, kAmple = 1.65;  // 3/2 is the least
  const GapJet<T>& o = f.start();
  const T b = o.g2 / T(2.0), soon = T(kSoon) / (abs(f.eta() + o.state.U) + f.mechanics().ratio + T(1.0));
  const T part = max(T(0.5), T(T(kAmple) * b * b / (o.g1 * o.g3)));
  const Truth<T> noise = !(o.g1 > T(0.0)) && !(b < T(-kReleaseNoise));
  const Truth<T> free = !(b < T(0.0)) || noise, up = o.g3 > T(0.0) && (free || part <= T(kMostPart));
  const T left = T(4.0) - T(4.0) * select(free, T(0.5), part);
  return select(up, min(soon, T(left * o.g3 / f.fourth_derivative_bound(soon))), T(0.0));
}
template <class T>
T leave_slowly(const Flight<T>& f, const T& quickly) {
  constexpr double kHardly = 0x1p-6;
  return either(
      quickly * f.bounds().fastest <= T(kHardly), [&] { return leave_slowly(f); }, [] { return T(0.0); });
}

// First positive root of g + g1 t + q t^2/2, or `none` where there is none. Precondition: g > 0.
template <class T>
T first_root(const T& g, const T& g1, const T& q, const T& none) {
  using std::sqrt;
  const T discriminant = g1 * g1 - T(2.0) * q * g;
  const auto falling = [&] { return T(T(2.0) * g / (sqrt(discriminant) - g1)); };
  const auto rising = [&] {
    return choose(
        q < T(0.0), [&] { return T((g1 + sqrt(discriminant)) / (-q)); }, [&] { return none; });
  };
  return choose(
      discriminant < T(0.0), [&] { return none; }, [&] { return choose(g1 < T(0.0), falling, rising); });
}

// A step over which the gap is certainly positive: on [0, S] it is at least g - error + g1 t + (g2 + low S/3) t^2/2
// where low, its third derivative's bound, is negative. Any S is safe; a good one lies just beyond the root it gives.
// None from a gap that is half rounding: so every step changes the gap by more than that, and they come to an end.
template <class T>
T safe_step(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& guess) {
  using std::min;
  const T g = jet.g - error;
  const auto root_within = [&](const T& S) {
    const T low = min(T(0.0), third_derivative_over(f, jet, S).low);
    return first_root(g, jet.g1, T(jet.g2 + over(T(low * S), 3.0)), S);
  };
  const auto sharpened = [&] {
    const T root = root_within(guess);
    return choose(
        root < guess,
        [&] {
          const T S = T(1.25) * root, next = root_within(S);
          return select(next < S, next, S);
        },
        [&] { return guess; });
  };
  return choose(g > error, sharpened, [] { return T(0.0); });
}

// The gap is certainly positive over all of the time `back` before the jet.
template <class T>
Truth<T> positive_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  const T g = jet.g - error;
  return both(g > T(0.0), [&] {
    const T high = max(T(0.0), third_derivative_over(f, jet, back).high);
    const T q = jet.g2 - over(T(high * back), 3.0), end = g + back * (q * back / T(2.0) - jet.g1);
    // a parabola that opens downwards has its least value at an end; another may dip in between
    return end > T(0.0) &&
           (!(q > T(0.0)) || jet.g1 * jet.g1 < T(2.0) * q * g || !(T(0.0) < jet.g1) || q * back < jet.g1);
  });
}

// An interval [low, high] about the present time on which the gap falls all the way, from above zero to below.
template <class T>
struct RootInterval {
  Truth<T> certain;
  T estimate, low, high;
};

// The root of the gap's series to the fourth order near that of the parabola, `t`: one step of Newton's.
template <class T>
T quartic_root(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const T g4 = fourth_derivative(f, jet);
  const T slope = mul_add(t, mul_add(t, mul_add(t, over(g4, 6.0), T(jet.g3 / T(2.0))), jet.g2), jet.g1);
  return t - (t * t * t) * over(mul_add(t, T(g4 / T(4.0)), jet.g3), 6.0) / slope;
}

// Nobody looks further ahead than that [tau], and bounds that end with the search need not hold there.
constexpr double kFarthestRoot = 8.0;

template <class T>
RootInterval<T> no_root() {
  const T zero(0.0);
  return {zero < zero, zero, zero, zero};
}

template <class T>
RootInterval<T> certify_root(const Flight<T>& f, const GapJet<T>& jet, const T& error) {
  using std::max;
  const T high = jet.g + error;
  const auto about = [&](const T& t) {
    const T d = T(1.25) * t + T(4.0) * error / -jet.g1;
    const T third = third_derivative_over(f, jet, d).high;
    const T slope = jet.g1 + max(T(0.0), T(jet.g2 * d + max(T(0.0), third) * d * d / T(2.0)));
    const T end = high + d * (jet.g1 + d * (jet.g2 / T(2.0) + over(T(d * third), 6.0)));
    return RootInterval<T>{slope < T(0.0) && end < T(0.0) && d < T(kFarthestRoot),
                           clamp(quartic_root(f, jet, t), T(0.0), d), T(0.0), d};
  };
  const auto falling = [&] {
    const T t = choose(
        high > T(0.0), [&] { return first_root(high, jet.g1, jet.g2, T(-1.0)); }, [] { return T(0.0); });
    return choose(t < T(0.0), no_root<T>, [&] { return about(t); });
  };
  return choose(jet.g1 < T(0.0), falling, no_root<T>);
}

// The same behind, where the gap is certainly positive at a time `back` before, and certainly negative now.
template <class T>
RootInterval<T> certify_root_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  using std::sqrt;
  const T discriminant = mul_add(T(T(-2.0) * jet.g2), jet.g, T(jet.g1 * jet.g1));
  const auto falling = [&] {
    const T third = max(T(0.0), third_derivative_over(f, jet, back).high);
    const T slope = jet.g1 + max(T(0.0), T(third * back * back / T(2.0) - jet.g2 * back));
    const T t = T(2.0) * jet.g / (sqrt(discriminant) - jet.g1);
    return RootInterval<T>{slope < T(0.0), clamp(quartic_root(f, jet, t), T(-back), T(0.0)), T(-back), T(0.0)};
  };
  const auto none = !(jet.g1 < T(0.0)) || !(jet.g + error < T(0.0)) || discriminant < T(0.0);
  return choose(none, no_root<T>, falling);
}

// angle / 2 pi of the point (x, y), y > 0, within 3e-6: it only isolates.
template <class R>
R rough_turn(const R& x, const R& y) {
  using std::abs;
  const R ax = abs(x);
  const auto steep = y > ax;
  const R t = select(steep, ax, y) / select(steep, y, ax);
  const R z = t * t;
  // Hastings' polynomial of the arctangent, |error| < 1e-5 rad
  const R low = mul_add(z, R(-0.3302995 / kTwoPi), R(0.9998660 / kTwoPi));
  const R high = mul_add(z, mul_add(z, R(0.0208351 / kTwoPi), R(-0.0851330 / kTwoPi)), R(0.1801410 / kTwoPi));
  const R part = t * mul_add(R(z * z), high, low), turn = select(steep, R(R(0.25) - part), part);
  return select(x < R(0.0), R(R(0.5) - turn), turn);
}

// The number in which a step is guessed: double is enough, whatever the digits of the flight.
template <class T>
double rough(const T& x) {
  return static_cast<double>(x);
}

// How long the tip needs from here over its top and down to the crest, less a margin; 0 where that is not worth a step.
template <class T>
T time_to_crest(const Flight<T>& f, const FlightState<T>& q) {
  using std::max;
  using std::sqrt;
  using R = decltype(rough(q.Y));
  constexpr double kMargin = 1e-5;  // [tau]: three times the error of rough_turn
  constexpr double kWorthwhile = 1e-3;
  const R crest = rough(T(f.mechanics().H - f.mechanics().y0));
  const R Y = rough(q.Y), V = rough(T(q.W * f.mechanics().per_omega_v));
  // turn from now to the top plus from the top down to the crest: the angle of a product of two complex numbers
  const R Q = sqrt(max(R(0.0), mul_add(V, V, mul_add(Y, Y, R(-crest * crest)))));
  const R sine = mul_add(Y, Q, R(V * crest));
  return choose(
      sine > R(0.0),
      [&] {
        const R down = rough_turn(mul_add(R(-V), Q, R(Y * crest)), sine) - R(kMargin);
        return T(select(down > R(kWorthwhile), down, R(0.0)));
      },
      [] { return T(0.0); });
}

// Above the crest nothing can happen: how long the tip stays there.
template <class T>
T time_above_crest(const Flight<T>& f, const FlightState<T>& q) {
  return either(
      q.Y > f.mechanics().H - f.mechanics().y0, [&] { return time_to_crest(f, q); }, [] { return T(0.0); });
}

// The same from the surface, where the tip certainly is above the crest at a time `s` up to which it certainly has left
// the surface.
template <class T>
T time_aloft(const Flight<T>& f, const T& s) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = f.start().state;
  const T least = q.Y + s * (q.W - s * (m.omega_v * m.omega_v * f.amplitude_Y() / T(2.0)));
  return either(
      least > m.H - m.y0, [&] { return time_to_crest(f, q); }, [] { return T(0.0); });
}

}  // namespace afm
