#include "afm_emulator/chatter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm_emulator/impact_steps.h"
#include "afm_emulator/multiversion.h"

namespace afm {
namespace {

// |w| up to which the series below are good to 3e-4
constexpr double kMostLoss = 0.2;
// The duration of a bounce against the time in which the pressure changes by itself, at most: an exit leaves two bounces.
constexpr double kMostShortness = 0.25;

// the pressure may fall to this part of itself in a step
constexpr double kMostFall = 0.75;

// The interpolation of w -> w (1 - w): R = G/T and 1/T.
double series_R(double w) {
  return 1.0 + w * (1.0 / 2 +
                    w * (7.0 / 12 + w * (7.0 / 8 + w * (1049.0 / 720 + w * (727.0 / 288 + w * (264917.0 / 60480))))));
}
double series_1_over_T(double w) {
  return 1.0 - w * (1.0 / 2 +
                    w * (5.0 / 12 + w * (5.0 / 8 + w * (811.0 / 720 + w * (629.0 / 288 + w * (261679.0 / 60480))))));
}

// Natural logarithm to 1e-15 of 0 < x, the same bits on every machine.
double portable_log(double x) {
  constexpr double kLog2 = 0.6931471805599453;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.7071067811865476) {
    m *= 2.0;
    --exponent;
  }
  const double z = (m - 1.0) / (m + 1.0), z2 = z * z;
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * z2 + 1.0 / k;
  return 2.0 * z * sum + exponent * kLog2;
}

double square(double x) { return x * x; }

}  // namespace

ChatterLaw::ChatterLaw(const Model& model, double threshold)
    : gamma_(model.gamma), v_c_(model.v_c), threshold_(threshold), H_(model.H), ratio_(model.frequency_ratio) {
  constexpr double kUsualThreshold = 1e-5;
  fineness_ = std::sqrt(std::sqrt(std::min(1.0, threshold / kUsualThreshold)));
  const double loss = 1.0 - gamma_;
  geometric_ =
      loss < 1e-8 ? 1.0 : (gamma_ > 0.0 ? -portable_log(gamma_) / loss : std::numeric_limits<double>::infinity());
}

// What the interpolation leaves out shifts a bounce by the fourth order of its duration against the changes of the pressure,
// and by the second against those of the slope and of the springs: those parts of v stay well below the threshold.
bool ChatterLaw::smooth(const Surroundings& at, double v) const {
  const double pressure = 2.0 * v * std::abs(at.a1) / square(at.a), rest = 2.0 * v * at.slow_rate / at.a;
  return pressure <= kMostShortness && 4.0 * v * square(square(pressure)) <= threshold_ && rest <= kMostShortness &&
         2.0 * v * square(rest) <= threshold_;
}

ChatterLaw::Surroundings ChatterLaw::surroundings(double a, double a1, double phase, double u) const {
  const SurfaceJet<double> surface = surface_jet(H_, phase);
  const double N2 = 1.0 + square(surface.h1), N = std::sqrt(N2);
  const double growth_of_N = surface.h1 * surface.h2 * u / N2;
  Surroundings at{};
  at.a = a;
  at.a1 = a1;
  at.growth = (a1 / a + 2.0 * growth_of_N) / 3.0;
  at.c = v_c_ > 0.0 ? (1.0 - gamma_) / (N * v_c_) : 0.0;
  at.delay = growth_of_N / a;
  at.slow_rate = std::max(std::abs(u), ratio_);
  return at;
}

ChatterLaw::Surroundings ChatterLaw::surroundings(const SlidePiece<double>& guide, double s) const {
  const SlideState<double> q = guide.at(s);
  const auto p = guide.pressure_jet(s);
  Surroundings at = surroundings(p[0], p[1], q.phase, q.u);
  const double a2 = square(p[0]), a4 = square(a2);
  at.stretch = (3.0 * p[0] * p[2] - 4.0 * square(p[1])) / (27.0 * a4);
  at.twist = (-3.0 * a2 * p[3] + 20.0 * p[1] * (p[0] * p[2] - square(p[1]))) / (135.0 * a4 * p[0]);
  return at;
}

ChatterLaw::Rate ChatterLaw::rate(const Surroundings& at, double v) const {
  const double stretch = 1.0 / (1.0 + at.stretch * v * v);
  const double adiabatic = v * at.growth * stretch + at.twist * v * v * v;
  if (v_c_ <= threshold_) return {-(1.0 - gamma_) * at.a / 2.0 + adiabatic, at.a / (2.0 * v * geometric_) * stretch};
  const double w = at.c * v * (1.0 - at.delay * v);
  const double per_T = series_1_over_T(w);
  return {-at.a / 2.0 * w * series_R(w) + adiabatic * per_T, at.a / (2.0 * v) * per_T * stretch};
}

AFM_MULTIVERSION bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const double v = bounce.start().g1, a = -bounce.start().g2;
  if (v <= threshold_) return true;
  const bool below = v_c_ > threshold_;
  if (!(a > 0.0) || (below && v > v_c_)) return false;
  const Surroundings at = surroundings(a, -higher_derivatives(bounce).g3, bounce.launch().phase, bounce.launch().u);
  return smooth(at, 1.25 * v) && (!below || at.c * v <= kMostLoss);
}

// Classical Runge-Kutta.
Chatter ChatterLaw::step(const SlidePiece<double>& guide, double s, double dt, const Surroundings& at,
                         const Surroundings& end, const Chatter& c) const {
  const Surroundings middle = surroundings(guide, s + dt / 2.0);
  const auto positive = [](double v) { return std::max(v, std::numeric_limits<double>::min()); };
  const Rate k1 = rate(at, c.v);
  const Rate k2 = rate(middle, positive(c.v + dt / 2.0 * k1.v));
  const Rate k3 = rate(middle, positive(c.v + dt / 2.0 * k2.v));
  const Rate k4 = rate(end, positive(c.v + dt * k3.v));
  return {c.v + dt / 6.0 * (k1.v + 2.0 * (k2.v + k3.v) + k4.v), c.n + dt / 6.0 * (k1.n + 2.0 * (k2.n + k3.n) + k4.n)};
}

// Parts of the times in which v and a change by themselves: at the threshold 1e-5, good to 3e-5 of n for each factor e that v
// falls, and to half the threshold of v. Smaller thresholds take smaller steps.
double ChatterLaw::step_length(const Surroundings& at, double v) const {
  const double loss = v_c_ <= threshold_ ? (1.0 - gamma_) * at.a / (2.0 * v) : at.c * at.a / 2.0;
  const double rate_of_v = loss + std::abs(at.growth), rate_of_a = std::abs(at.a1) / at.a;
  const double dt = fineness_ / std::max(4.0 * rate_of_v, 8.0 * rate_of_a);
  // and not far beyond the threshold, so that n counts the bounces down to it
  const double fall = -rate(at, v).v;
  return fall > 0.0 ? std::min(dt, 1.02 * (v - threshold_) / fall) : dt;
}

// The first whole n in a step of which the end is known: bracketed, as n only grows.
ChatterRun ChatterLaw::whole_bounce(const SlidePiece<double>& guide, double s, double dt, const Surroundings& at,
                                    const Chatter& start, const Chatter& end) const {
  const double n = std::floor(start.n) + 1.0;
  double low = 0.0, high = dt, part = dt * (n - start.n) / (end.n - start.n);
  Chatter c = start;
  constexpr int kMostSteps = 40;
  for (int i = 0; i < kMostSteps; ++i) {
    const Surroundings there = surroundings(guide, s + part);
    c = step(guide, s, part, at, there, start);
    const double rest = n - c.n;
    if (std::abs(rest) < 1e-9) break;
    (rest > 0.0 ? low : high) = part;
    const double newton = part + rest / rate(there, c.v).n;
    part = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return {ChatterEnd::exits, s + part, {c.v, n}};
}

// A step that ends where the interpolation no longer holds is gone back from, to its first whole bounce. Without exits, for
// the state in the middle of a burst, it is not asked.
AFM_MULTIVERSION ChatterRun ChatterLaw::follow(const SlidePiece<double>& guide, double from, double until,
                                               const Chatter& start, bool exits) const {
  double s = from;
  Chatter c = start;
  Surroundings at = surroundings(guide, s);
  while (s < until && c.v > threshold_) {
    double dt = std::min(until - s, step_length(at, c.v));
    Surroundings then = surroundings(guide, s + dt);
    // the last bounce of all lasts beyond the pressure: it is left where it is
    if (!(s + dt > s) || 2.0 * c.v * std::abs(at.a1) > square(at.a)) return {ChatterEnd::exits, s, c};
    // past a maximum the pressure may fall faster than its rate foretells
    for (; !(then.a > kMostFall * at.a); then = surroundings(guide, s + dt)) {
      dt *= 0.5;
      if (!(s + dt > s)) return {ChatterEnd::exits, s, c};
    }
    const Chatter next = step(guide, s, dt, at, then, c);
    if (exits && !smooth(then, next.v) && next.n >= std::floor(c.n) + 1.0)
      return whole_bounce(guide, s, dt, at, c, next);
    s += dt;
    c = next;
    at = then;
  }
  return {c.v <= threshold_ ? ChatterEnd::died : ChatterEnd::time, s, c};
}

ChatterRun ChatterLaw::run(const SlidePiece<double>& guide, double from, double until, const Chatter& start) const {
  return follow(guide, from, until, start, true);
}

Chatter ChatterLaw::at(const SlidePiece<double>& guide, double s, const Chatter& start) const {
  return follow(guide, 0.0, s, start, false).chatter;
}

Settled settle(const Model& model, const TipState& state) {
  const double slope = surface_jet(model.H, state.phase).h1;
  const double N2 = 1.0 + square(slope), N = std::sqrt(N2);
  const double u = state.u + slope * state.g1 / N2;
  return {{state.phase, state.X, u}, state.g1 / N, u * N};
}

TipState unsettle(const Model& model, const SlideState<double>& guide, double gap_rate) {
  const double slope = surface_jet(model.H, guide.phase).h1;
  return {wrap_phase(guide.phase), guide.X, guide.u - slope * gap_rate / (1.0 + square(slope)), 0.0, gap_rate};
}

}  // namespace afm
