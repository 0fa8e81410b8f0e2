// Sine and cosine of angles counted in turns. Every angle of the model is one: the surface phase, the vertical spring
// (1 turn per tau), the horizontal spring (omega_h/omega_v turns per tau). Range reduction is one exact subtraction,
// and the same bits come out on every machine.
#pragma once

#include <cmath>

namespace afm {

template <class T>
struct SinCos {
  T sin, cos;
};

// A turn of at most 1/8, with the parts that cancel in small differences kept apart, each to a few ulp of itself.
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

namespace turns_detail {

// (2 pi)^n / n! with alternating signs: at an eighth turn the first term left out is below 1e-18
constexpr double kTwoPiHigh = 6.283185307179586, kTwoPiLow = 2.4492935982947064e-16;
constexpr double kS3 = -41.34170224039976, kS3Low = 1.8132498260631558e-15;  // and its rounding
constexpr double kS5 = 81.60524927607506, kS7 = -76.70585975306139;
constexpr double kS9 = 42.058693944897655, kS11 = -15.09464257682299, kS13 = 3.819952584848282;
constexpr double kS15 = -0.7181223017785006, kS17 = 0.10422916220813984;
constexpr double kC2 = -19.739208802178716, kC2Low = -1.2530591017506564e-15;  // and its rounding
constexpr double kC4 = 64.9393940226683, kC6 = -85.45681720669373;
constexpr double kC8 = 60.24464137187666, kC10 = -26.4262567833744, kC12 = 7.903536371318469;
constexpr double kC14 = -1.714390711088672, kC16 = 0.28200596845579123;

// (sin(2 pi x) - 2 pi x) / x^3 and (cos(2 pi x) - 1) / x^2, z = x^2, paired to shorten the chain of dependencies
inline double sine_tail(double z) {
  const double z2 = z * z, z4 = z2 * z2;
  const double low = std::fma(std::fma(z, kS9, kS7), z2, kS3 + std::fma(z, kS5, kS3Low));
  const double high = std::fma(std::fma(z, kS17, kS15), z2, std::fma(z, kS13, kS11));
  return std::fma(high, z4, low);
}
inline double cosine_rest(double z) {  // the same less kC2, over z
  const double z2 = z * z;
  const double low = std::fma(kC8, z2, std::fma(z, kC6, kC4));
  const double high = std::fma(kC16, z2, std::fma(z, kC14, kC12));
  return std::fma(std::fma(high, z, kC10), z2 * z, low);
}
inline double cosine_tail(double z) { return kC2 + std::fma(z, cosine_rest(z), kC2Low); }
// 1 + z kC2 is kept in two parts and kC2 with its rounding: a cosine too large by 1e-17 on average is energy from nothing
inline double cosine(double x, double z) {
  const double z_low = std::fma(x, x, -z);
  const double head = std::fma(z, kC2, 1.0), head_low = std::fma(z, kC2, 1.0 - head);
  const double rest = std::fma(z, kC2Low, std::fma(z_low, kC2, head_low));
  return head + std::fma(z * z, cosine_rest(z), rest);
}
inline double sine(double x, double z) { return std::fma(x, kTwoPiHigh, x * std::fma(z, sine_tail(z), kTwoPiLow)); }

// adding and taking away 1.5 * 2^52 rounds to the nearest whole number
constexpr double kRounder = 6755399441055744.0;

}  // namespace turns_detail

// Nearest whole number, |x| < 2^51.
inline double nearest(double x) { return (x + turns_detail::kRounder) - turns_detail::kRounder; }

// a * b less a whole number: the fraction keeps its bits however large the product, |a b| < 2^51.
inline double turn_product(double a, double b) { return std::fma(a, b, -nearest(a * b)); }

// Within 0.8 ulp, |x| < 2^49 turns.
inline SinCos<double> sin_cos_turns(double x) {
  const double quarter = nearest(4.0 * x);
  const double r = std::fma(-0.25, quarter, x);
  const double z = r * r;
  const double s = turns_detail::sine(r, z), c = turns_detail::cosine(r, z);
  const long long k = static_cast<long long>(quarter);
  const bool swap = (k & 1) != 0;
  const double sin_value = swap ? c : s, cos_value = swap ? s : c;
  return {(k & 2) != 0 ? -sin_value : sin_value, ((k + 1) & 2) != 0 ? -cos_value : cos_value};
}

// Precondition: |x| <= 1/8.
inline SmallTurn<double> small_turn(double x) {
  const double z = x * x;
  return {turns_detail::sine(x, z), x * z * turns_detail::sine_tail(z), -z * turns_detail::cosine_tail(z)};
}

// The same in fewer terms. Precondition: |x| <= 2^-10.
inline SmallTurn<double> tiny_turn(double x) {
  using namespace turns_detail;
  const double z = x * x;
  const double sine_tail = std::fma(z, std::fma(z, kS7, kS5), kS3);
  const double cosine_tail = std::fma(z, std::fma(z, kC6, kC4), kC2);
  return {std::fma(x, kTwoPiHigh, x * std::fma(z, sine_tail, kTwoPiLow)), x * z * sine_tail, -z * cosine_tail};
}
template <class T>
SmallTurn<T> tiny_turn(const T& x) {
  return small_turn(x);
}

}  // namespace afm
