// Where the reaction along a step in contact falls, and its impulse (docs/algorithm.md, "Contact").

#include "bernstein_fall.h"
#include "core/release_noise.h"
#include "gauss.h"

namespace afm::detail {

double ContactStep::first_below(double reaction) const {
  constexpr int kHalvings = 4;
  AtGaussNodes b;
  enclose(reaction_, b);
  for (double& x : b) x -= reaction;
  return first_bernstein_fall(b, 0.0, length_, kHalvings);
}

double ContactStep::impulse(double s) const {
  const double part = s / length_;
  double sum = 0.0;
  for (std::size_t m = kGaussNodes; m-- > 0;) {
    sum = sum * part + coefficient(m, reaction_) / static_cast<double>(m + 1);
  }
  return sum * s;
}

double ContactStep::find_release() const {
  constexpr int kHalvings = 12;               // to 1/4000 of the step; the rest is done on the reaction itself
  constexpr int kMaxTries = 60;               // bisection alone needs 50
  constexpr double kAccuracy = 1.0 / 1024.0;  // of the noise: finer would be rounding of the reaction
  const double noise = release_noise(m_, start_.u, start_.X), zero = kAccuracy * noise;
  const auto pressed = [&](double t) { return pressure(at(t)) + noise; };
  double low = 0.0, low_p = first_.reaction + noise;
  if (low_p <= zero) return 0.0;
  AtGaussNodes b;
  enclose(reaction_, b);
  for (double& x : b) x += noise;
  b[0] = low_p;
  double s = 0.0, p = low_p;
  for (int i = 0; i < kMaxTries && p > zero; ++i) {
    s = first_bernstein_fall(b, 0.0, length_, kHalvings);
    if (s < 0.0) return -1.0;
    p = pressed(s);
    if (p > 0.0) low = s, low_p = p;
    for (double& x : b) x += p;  // so much the interpolation is off
  }
  // secants, and bisection where they lead out
  double high = s, other = low, other_p = low_p;
  for (int i = 0; i < kMaxTries && std::fabs(p) > zero; ++i) {
    const double next = s - p * (s - other) / (p - other_p), middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) break;  // neighbouring times
    other = s, other_p = p;
    s = low < next && next < high ? next : middle;
    p = pressed(s);
    (p > 0.0 ? low : high) = s;
  }
  return p <= zero ? s : high;
}

}  // namespace afm::detail
