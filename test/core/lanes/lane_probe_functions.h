// The functions that a pack must give lane by lane as a number does. T: double or a pack.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/impact_search.h"
#include "lane_probe.h"

namespace afm {
namespace {

template <class T>
void probe_functions(const T& x, const T& y, const T& z, T results[kProbeResults]) {
  using std::floor;
  using std::fma;
  using std::min;
  int n = 0;
  const auto add = [&](const T& value) { results[n++] = value; };
  const T zero(0.0), one(1.0);
  add(x + y), add(x - y), add(x * y), add(-x), add(fma(x, y, z));
  add(min(x, y)), add(floor(x)), add(wrapped(x));
  add(select(x < y, one, zero)), add(select(x <= y, one, zero));
  const SinCos<T> turn = sin_cos_turns(x);
  add(turn.sin), add(turn.cos), add(turn_product(x, y));
  const SmallTurn<T> small = small_turn(y);
  add(small.sin), add(small.sin_minus_angle), add(small.versine);
  add(over(x, 3.0)), add(over(x, 6.0)), add(over(x, 12.0));
}

}  // namespace
}  // namespace afm
