// Sine and cosine of angles in turns. Every angle of the model is one: the surface phase, the vertical spring (1 turn
// per tau), the horizontal spring (omega_h/omega_v turns per tau). Range reduction is one exact subtraction. Guarantee:
// the same bits on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace afm::detail {

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
inline double two_pi<double>() {
  return 6.283185307179586476925286766559;
}

// (2 pi)^n / n! with alternating signs, up to n = 17: at an eighth of a turn the first omitted term is below 3e-18
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

// (sin(2 pi x) - 2 pi x) / x^3 - kSine[1], and ((cos(2 pi x) - 1) / x^2 - kCosine[1]) / x^2, with z = x^2. Terms are
// paired to shorten the chain of dependent operations.
inline double sine_rest(double z) {
  const double z2 = z * z, z4 = z2 * z2;
  const double low = std::fma(std::fma(z, kSine[4], kSine[3]), z2, std::fma(z, kSine[2], kSineLow[1]));
  const double high = std::fma(std::fma(z, kSine[8], kSine[7]), z2, std::fma(z, kSine[6], kSine[5]));
  return std::fma(high, z4, low);
}
inline double cosine_rest(double z) {
  const double z2 = z * z;
  const double low = std::fma(kCosine[4], z2, std::fma(z, kCosine[3], kCosine[2]));
  const double high = std::fma(kCosine[8], z2, std::fma(z, kCosine[7], kCosine[6]));
  return std::fma(std::fma(high, z, kCosine[5]), z2 * z, low);
}
// 1 + z kCosine[1] is kept in two parts, and kCosine[1] with its rounding: a cosine that is too large by 1e-17 on
// average would add energy.
inline double cosine(double x, double z) {
  const double over_z = std::fma(-x, x, z);  // rounding of z = x^2
  const double head = std::fma(z, kCosine[1], 1.0), head_low = std::fma(z, kCosine[1], 1.0 - head);
  const double rest = head_low + std::fma(over_z, -kCosine[1], z * std::fma(z, kCosineLow[2], kCosineLow[1]));
  return head + std::fma(z * z, cosine_rest(z), rest);
}
inline double sine(double x, double z) {
  const double cube = x * z;
  return std::fma(x, kSine[0], std::fma(cube, sine_rest(z), std::fma(cube, kSine[1], x * kSineLow[0])));
}

// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer; a quarter of it to the nearest quarter.
constexpr double kRounder = 6755399441055744.0, kQuarterRounder = 1688849860263936.0;

// Sine and cosine of the angle r + q. `quarters`: q, a whole number of quarters of a turn, plus kQuarterRounder.
inline SinCos<double> sin_cos_beside(double quarters, double r) {
  const double z = r * r, s = sine(r, z), c = cosine(r, z);
  std::uint64_t k;  // its last two bits count quarters: the last bit of `quarters` is one
  std::memcpy(&k, &quarters, sizeof k);
  const bool swap = (k & 1) != 0;
  const double sin_value = swap ? c : s, cos_value = swap ? s : c;
  return {(k & 2) != 0 ? -sin_value : sin_value, ((k + 1) & 2) != 0 ? -cos_value : cos_value};
}

// Nearest whole number, |x| < 2^51.
inline double nearest(double x) { return (x + kRounder) - kRounder; }

// a * b minus the nearest integer, rounded once. Precondition: |a b| < 2^51.
inline double turn_product(double a, double b) { return std::fma(a, b, -nearest(a * b)); }

// Error below 0.8 ulp. Precondition: |x| < 2^49.
inline SinCos<double> sin_cos_turns(double x) {
  const double quarters = x + kQuarterRounder;
  return sin_cos_beside(quarters, x - (quarters - kQuarterRounder));
}

// The turn of a * b, reduced as in turn_product. Precondition: |a b| < 2^49.
inline SinCos<double> sin_cos_turn_product(double a, double b) {
  const double quarters = std::fma(a, b, kQuarterRounder);
  return sin_cos_beside(quarters, std::fma(a, b, kQuarterRounder - quarters));
}
template <class T>
SinCos<T> sin_cos_turn_product(const T& a, const T& b) {
  return sin_cos_turns(turn_product(a, b));
}

constexpr double kSmallTurn = 0.125;  // [turns] limit of SmallTurn, which also bounds the error of the series above

// Precondition: |x| <= 1/8.
inline SmallTurn<double> small_turn(double x) {
  const double z = x * x, cube = x * z;
  const double low = z * std::fma(z, -kCosineLow[2], -kCosineLow[1]);
  return {sine(x, z), std::fma(cube, sine_rest(z), cube * kSine[1]),
          std::fma(-(z * z), cosine_rest(z), std::fma(z, -kCosine[1], low))};
}

}  // namespace afm::detail
