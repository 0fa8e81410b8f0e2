// Sine and cosine of angles in turns. Every angle of the model is one: the surface phase, the vertical spring (1 turn
// per tau), the horizontal spring (omega_h/omega_v turns per tau). Range reduction is one exact subtraction. Guarantee:
// the same bits on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "multiversion.h"

namespace afm {

template <class T>
struct SinCos {
  T sin, cos;
};

// For a turn of at most 1/8. Parts that cancel in small differences are separate, each exact to a few ulp of itself.
template <class T>
struct SmallTurn {
  T sin;
  T sin_minus_angle;  // sin(2 pi x) - 2 pi x
  T versine;          // 1 - cos(2 pi x)
};

// One unit in the last place of 1.
template <class T>
T epsilon();
template <>
inline double epsilon<double>() {
  return 2.220446049250313e-16;
}

template <class T>
T two_pi();
template <>
AFM_INLINED double two_pi<double>() {
  return 6.283185307179586476925286766559;
}

namespace turns_detail {

// (2 pi)^n / n! with alternating signs, up to n = 17: at an eighth of a turn the first omitted term is below 1e-18
constexpr double kSine[] = {6.283185307179586,  -41.34170224039976,  81.60524927607506,
                            -76.70585975306139, 42.058693944897655,  -15.09464257682299,
                            3.819952584848282,  -0.7181223017785006, 0.10422916220813984};  // n = 1, 3 .. 17
constexpr double kCosine[] = {1.0,
                              -19.739208802178716,
                              64.9393940226683,
                              -85.45681720669373,
                              60.24464137187666,
                              -26.4262567833744,
                              7.903536371318469,
                              -1.714390711088672,
                              0.28200596845579123};  // 0, 2 .. 16
// what the first of them lack to their exact values
constexpr double kSineLow[] = {2.4492935982947064e-16, 1.8132498260631558e-15};
constexpr double kCosineLow[] = {0.0, -1.2530591017506564e-15, -4.256320131887783e-15};

using std::fma;  // packs of lanes have their own

// (sin(2 pi x) - 2 pi x) / x^3 - kSine[1], and ((cos(2 pi x) - 1) / x^2 - kCosine[1]) / x^2, with z = x^2. Terms are
// paired to shorten the chain of dependent operations.
template <class T>
AFM_INLINED T sine_rest(T z) {
  const T z2 = z * z, z4 = z2 * z2;
  const T low = fma(fma(z, T(kSine[4]), T(kSine[3])), z2, fma(z, T(kSine[2]), T(kSineLow[1])));
  const T high = fma(fma(z, T(kSine[8]), T(kSine[7])), z2, fma(z, T(kSine[6]), T(kSine[5])));
  return fma(high, z4, low);
}
template <class T>
AFM_INLINED T cosine_rest(T z) {
  const T z2 = z * z;
  const T low = fma(T(kCosine[4]), z2, fma(z, T(kCosine[3]), T(kCosine[2])));
  const T high = fma(T(kCosine[8]), z2, fma(z, T(kCosine[7]), T(kCosine[6])));
  return fma(fma(high, z, T(kCosine[5])), z2 * z, low);
}
// 1 + z kCosine[1] is kept in two parts, and kCosine[1] with its rounding: a cosine that is too large by 1e-17 on
// average would add energy.
template <class T>
AFM_INLINED T cosine(T x, T z) {
  const T over_z = fma(-x, x, z);  // rounding of z = x^2
  const T head = fma(z, T(kCosine[1]), T(1.0)), head_low = fma(z, T(kCosine[1]), T(1.0) - head);
  const T rest = head_low + fma(over_z, T(-kCosine[1]), z * fma(z, T(kCosineLow[2]), T(kCosineLow[1])));
  return head + fma(z * z, cosine_rest(z), rest);
}
template <class T>
AFM_INLINED T sine(T x, T z) {
  const T cube = x * z;
  return fma(x, T(kSine[0]), fma(cube, sine_rest(z), fma(cube, T(kSine[1]), x * T(kSineLow[0]))));
}

// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer; a quarter of it to the nearest quarter.
constexpr double kRounder = 6755399441055744.0, kQuarterRounder = 1688849860263936.0;

// Sine and cosine of an angle from s and c, those of its rest after subtracting whole quarters of a turn. `quarters` is
// these quarters plus kQuarterRounder.
AFM_INLINED SinCos<double> turn_quarters(double quarters, double s, double c) {
  const long long k = static_cast<long long>(4.0 * (quarters - kQuarterRounder));
  const bool swap = (k & 1) != 0;
  const double sin_value = swap ? c : s, cos_value = swap ? s : c;
  return {(k & 2) != 0 ? -sin_value : sin_value, ((k + 1) & 2) != 0 ? -cos_value : cos_value};
}

template <class T>
AFM_INLINED T nearest_of(T x) {
  return (x + T(kRounder)) - T(kRounder);
}

template <class T>
AFM_INLINED SinCos<T> sin_cos_beside(T quarters, T r) {
  const T z = r * r;
  const T s = sine(r, z), c = cosine(r, z);
  return turn_quarters(quarters, s, c);
}
template <class T>
AFM_INLINED SinCos<T> sin_cos_of(T x) {
  const T quarters = x + T(kQuarterRounder);
  return sin_cos_beside(quarters, T(x - (quarters - T(kQuarterRounder))));
}
template <class T>
AFM_INLINED SinCos<T> sin_cos_of_product(T a, T b) {
  const T quarters = fma(a, b, T(kQuarterRounder));
  return sin_cos_beside(quarters, T(fma(a, b, T(kQuarterRounder) - quarters)));
}

template <class T>
AFM_INLINED SmallTurn<T> small_turn_of(T x) {
  const T z = x * x, cube = x * z;
  return {sine(x, z), fma(cube, sine_rest(z), cube * T(kSine[1])),
          fma(-(z * z), cosine_rest(z), fma(z, T(-kCosine[1]), z * fma(z, T(-kCosineLow[2]), T(-kCosineLow[1]))))};
}

}  // namespace turns_detail

// Nearest whole number, |x| < 2^51.
AFM_INLINED double nearest(double x) { return turns_detail::nearest_of(x); }

// a * b minus the nearest integer, rounded once. Precondition: |a b| < 2^51.
AFM_INLINED double turn_product(double a, double b) { return std::fma(a, b, -nearest(a * b)); }

// Error below 0.8 ulp. Precondition: |x| < 2^49.
AFM_INLINED SinCos<double> sin_cos_turns(double x) { return turns_detail::sin_cos_of(x); }

// Of a * b, reduced as in turn_product. Precondition: |a b| < 2^49.
AFM_INLINED SinCos<double> sin_cos_turn_product(double a, double b) { return turns_detail::sin_cos_of_product(a, b); }
template <class T>
SinCos<T> sin_cos_turn_product(const T& a, const T& b) {
  return sin_cos_turns(turn_product(a, b));
}

constexpr double kSmallTurn = 0.125;  // [turns] limit of SmallTurn, which also bounds the error of the series above

// Precondition: |x| <= 1/8.
AFM_INLINED SmallTurn<double> small_turn(double x) { return turns_detail::small_turn_of(x); }

}  // namespace afm
