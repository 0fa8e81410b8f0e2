#include "double_double.h"

namespace afm::detail {

// Taylor series. At an eighth of a turn the first omitted term is below 2^-106.
SmallTurn<DoubleDouble> small_turn(const DoubleDouble& x) {
  constexpr int kTerms = 15;
  const DoubleDouble angle = two_pi<DoubleDouble>() * x, square = angle * angle;
  DoubleDouble sine_term = angle, cosine_term = 1.0;
  DoubleDouble sine_tail = 0.0, versine = 0.0;
  for (int k = 1; k <= kTerms; ++k) {
    const double n = 2.0 * k;
    cosine_term = -(cosine_term * square) / DoubleDouble(n * (n - 1.0));
    versine = versine - cosine_term;
    sine_term = -(sine_term * square) / DoubleDouble(n * (n + 1.0));
    sine_tail = sine_tail + sine_term;
  }
  return {angle + sine_tail, sine_tail, versine};
}

SinCos<DoubleDouble> sin_cos_turns(const DoubleDouble& x) {
  const double quarter = nearest(4.0 * x.high());
  const SmallTurn<DoubleDouble> r = small_turn(x - DoubleDouble(0.25 * quarter));
  const DoubleDouble c = DoubleDouble(1.0) - r.versine;
  switch (static_cast<long long>(quarter) & 3) {
    case 0:
      return {r.sin, c};
    case 1:
      return {c, -r.sin};
    case 2:
      return {-r.sin, -c};
    default:
      return {-c, r.sin};
  }
}

}  // namespace afm::detail
