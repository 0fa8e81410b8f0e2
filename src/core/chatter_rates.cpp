#include "afm_emulator/chatter_rates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "afm_emulator/impact_steps.h"
#include "afm_emulator/multiversion.h"

namespace afm {
namespace {

// The interpolation of w -> w (1 - w): R = G/T and 1/T. Terms are paired, to shorten the chain of dependencies.
AFM_INLINED double series_R(double w) {
  const double w2 = w * w, low = std::fma(w2, std::fma(w, 7.0 / 8, 7.0 / 12), std::fma(w, 0.5, 1.0));
  return std::fma(w2 * w2, std::fma(w2, 264917.0 / 60480, std::fma(w, 727.0 / 288, 1049.0 / 720)), low);
}
AFM_INLINED double series_1_over_T(double w) {
  const double w2 = w * w, low = std::fma(-w2, std::fma(w, 5.0 / 8, 5.0 / 12), std::fma(-w, 0.5, 1.0));
  return std::fma(-w2 * w2, std::fma(w2, 261679.0 / 60480, std::fma(w, 629.0 / 288, 811.0 / 720)), low);
}

// Natural logarithm to 1e-15 of 0 < x, the same bits on every machine.
AFM_INLINED double portable_log(double x) {
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

// e^x to 1e-15, likewise. Precondition: |x| < 700.
AFM_INLINED double portable_exp(double x) {
  constexpr double kLog2High = 0.693147180369123816490, kLog2Low = 1.90821492927058770002e-10;
  constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52: adding and taking it away rounds to a whole number
  const double k = (x * 1.4426950408889634 + kRounder) - kRounder;
  const double r = std::fma(-k, kLog2Low, std::fma(-k, kLog2High, x));
  const double r2 = r * r, r4 = r2 * r2;
  // terms in pairs, pairs in pairs: little waits for what is before it
  const auto pair = [&](double c0, double c1) { return std::fma(r, c1, c0); };
  const double p0 = std::fma(r2, pair(1.0 / 2, 1.0 / 6), 1.0 + r);
  const double p4 = std::fma(r2, pair(1.0 / 720, 1.0 / 5040), pair(1.0 / 24, 1.0 / 120));
  const double p8 = std::fma(r2, pair(1.0 / 3628800, 1.0 / 39916800), pair(1.0 / 40320, 1.0 / 362880));
  const double p12 = pair(1.0 / 479001600, 1.0 / 6227020800.0);
  const double sum = std::fma(r4 * r4, std::fma(r4, p12, p8), std::fma(r4, p4, p0));
  const std::uint64_t bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023) << 52;  // 2^k
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return sum * power;
}

AFM_INLINED double square(double x) { return x * x; }

AFM_INLINED double even_speed(bool geometric, double v) { return geometric ? v : portable_log(v); }

double mean_over_first(double gamma) {
  const double loss = 1.0 - gamma;
  if (loss < 1e-8) return 1.0;
  return gamma > 0.0 ? -portable_log(gamma) / loss : std::numeric_limits<double>::infinity();
}

}  // namespace

ChatterRates::ChatterRates(const Model& model, bool geometric)
    : geometric_(geometric),
      gamma_(model.gamma),
      H_(model.H),
      wv2_(square(kTwoPi)),
      free_(mobility(model)),
      wh2_(free_ * square(kTwoPi * model.frequency_ratio)),
      slow_rate_(std::max(1.0, free_ * model.frequency_ratio)),
      loss_(geometric ? 0.0 : (1.0 - model.gamma) / model.v_c),
      per_mean_(1.0 / mean_over_first(model.gamma)) {
  // no more than rounding allows where the loss is next to nothing: then n alone changes evenly
  constexpr double kLeastLoss = 1e-4;
  const double loss = geometric ? 1.0 - gamma_ : loss_;
  even_ = loss > kLeastLoss ? (geometric ? per_mean_ : 1.0) / loss : 0.0;
}

AFM_MULTIVERSION ChatterSurroundings ChatterRates::surroundings(const Flight<double>& bounce) const {
  const TipState& q = bounce.launch();
  const SurfaceJet<double> h = surface_jet(H_, q.phase);
  const double a = -bounce.start().g2, a1 = -bounce.start().g3, N2 = 1.0 + free_ * square(h.h1);
  ChatterSurroundings at{};
  at.P = a / std::sqrt(N2);
  at.per_P = 1.0 / at.P;
  at.squeeze = (a1 / a - free_ * h.h1 * h.h2 * q.u / N2) / 3.0;
  // the second derivative of the pressure, with what the horizontal spring and the reaction change u by
  const double u = q.u, u2 = square(u), k2 = square(kTwoPi), reaction = free_ * a / N2;
  const double x2 = -wh2_ * q.X - h.h1 * reaction, x3 = -wh2_ * (u - bounce.eta()) - h.h2 * u * reaction, x4 = -wh2_ * x2;
  const double a2 = h.h2 * (u2 * (wv2_ - k2 * u2) + 3.0 * square(x2) + 4.0 * u * x3) +
                    h.h1 * ((wv2_ - 6.0 * k2 * u2) * x2 + x4);
  at.quickness = std::sqrt(std::max(9.0 * square(at.squeeze), std::abs(a2) / a));
  at.speed = std::abs(q.u);
  at.slow_rate = std::max(at.speed, slow_rate_);
  return at;
}

AFM_INLINED ChatterSurroundings ChatterRates::look(const SlideState<double>& q, const std::array<double, 4>& a) const {
  SurfaceJet<double> h = surface_jet(H_, q.phase);
  // held along x, the tip sees no slope: only that the pressure changes
  h.h1 *= free_, h.h2 *= free_, h.h3 *= free_;
  const double u = q.u, N2 = 1.0 + square(h.h1), per_N2 = 1.0 / N2, per_N = std::sqrt(per_N2), per_a = 1.0 / a[0];
  const double x2 = -wh2_ * q.X - h.h1 * a[0];  // of the guide, with the reaction on it
  // the rate at which the surface turns under the tip, and its rate; from them those of ln N, and from these P'/P, ...
  // with P = N a
  const double turn = h.h2 * u * per_N2, turn1 = (h.h3 * u * u + h.h2 * x2) * per_N2 - 2.0 * h.h1 * square(turn);
  const double L1 = h.h1 * turn, L2 = h.h2 * u * turn + h.h1 * turn1;
  const double q1 = a[1] * per_a, q2 = a[2] * per_a, q3 = a[3] * per_a;
  const double p1 = q1 + L1, b2 = q2 - square(q1) + L2, b3 = q3 - 3.0 * q1 * q2 + 2.0 * q1 * square(q1);
  const double p2 = b2 + square(p1), p3 = b3 + 3.0 * p1 * b2 + p1 * square(p1);
  const double K = 3.0 * square(turn) + (wh2_ * square(h.h1) + wv2_) * per_N2;
  const double K1 = 6.0 * turn * turn1 + 2.0 * L1 * (wh2_ - wv2_) * per_N2;
  const double P = a[0] * N2 * per_N, per_P = per_a * per_N, per_P2 = square(per_P);
  ChatterSurroundings at{};
  at.P = P;
  at.per_P = per_P;
  at.squeeze = p1 / 3.0;
  at.stretch = ((3.0 * p2 - 4.0 * square(p1)) / 27.0 - K / 3.0) * per_P2;
  at.twist = ((-3.0 * p3 + 20.0 * p1 * (p2 - square(p1))) / 135.0 + (K1 - 3.0 * K * p1) / 15.0) * per_P2;
  at.lag = (p2 - 2.0 * square(p1)) * per_P / 18.0;
  at.turn = turn;
  // curvature k = h''/N^3, its rate along the surface, speed N u, acceleration along the surface from the springs alone
  const double curvature = h.h2 * per_N2 * per_N,
               curvature1 = (h.h3 - 3.0 * h.h1 * square(h.h2) * per_N2) * square(per_N2);
  const double pull = (x2 + L1 * u) * N2 * per_N, speed2 = square(u) * N2;
  at.lean = h.h1 * (wh2_ - wv2_) * per_N2 - curvature * pull - curvature1 * speed2;
  at.stiffness = (wh2_ + wv2_ * square(h.h1)) * per_N2 - curvature * (curvature * speed2 - P);
  at.quickness = std::sqrt(std::max(square(p1), std::abs(p2)));
  at.along = free_ * per_N;
  at.up = -h.h1 * per_N;
  at.speed = std::abs(u);
  at.slow_rate = std::max(at.speed, slow_rate_);
  return at;
}

namespace {

// The reaction off the guide over that on it, less 1. The action keeps v^3/P.
AFM_INLINED double disturbance(const ChatterSurroundings& at, double sigma, double p) {
  return (2.0 * at.turn * p - at.lean * sigma) * at.per_P;
}

}  // namespace

AFM_INLINED double ChatterRates::speed(double x) const {
  return geometric_ ? std::max(x, std::numeric_limits<double>::min()) : portable_exp(x);
}

double ChatterRates::x_of(double v) const { return even_speed(geometric_, v); }

AFM_INLINED double ChatterRates::bounces_at(double v) const {
  return geometric_ ? -even_ * portable_log(v) : even_ / v;
}

AFM_MULTIVERSION EvenChatter ChatterRates::even(const ChatterSurroundings& at, const Chatter& c) const {
  const double v = c.v * (1.0 - disturbance(at, c.sigma, c.p) / 3.0);
  return {even_speed(geometric_, v), c.n - bounces_at(v), c.sigma, c.p, c.drift, c.lift};
}

AFM_MULTIVERSION Chatter ChatterRates::plain(const ChatterSurroundings& at, const EvenChatter& c) const {
  const double v = speed(c.x);
  return {v * (1.0 + disturbance(at, c.sigma, c.p) / 3.0), c.rest + bounces_at(v), c.sigma, c.p, c.drift, c.lift};
}

double ChatterRates::fall_time(const ChatterSurroundings& at, double v) const {
  return 2.0 * at.per_P * (geometric_ ? v / (1.0 - gamma_) : 1.0 / loss_);
}

// Products of two terms of the second order are left out: what is kept is no better.
AFM_INLINED EvenChatter ChatterRates::rate(const ChatterSurroundings& at, const EvenChatter& c) const {
  const double on_guide = speed(c.x), per_v = 1.0 / on_guide;
  const double more = disturbance(at, c.sigma, c.p), v = on_guide * (1.0 + more / 3.0), v2 = v * v;
  const double height = v2 * at.per_P / 3.0, longer = at.stretch * v2, shorter = 1.0 - longer * (1.0 - longer);
  const double bounces = 0.5 * at.P * per_v * (1.0 + more * (2.0 / 3.0)) * shorter;
  const double adiabatic = at.squeeze * shorter + at.twist * v2;  // of ln v, as are those below
  const double sigma = c.p + 2.0 * at.turn * height, p = at.lean * height - at.stiffness * c.sigma;
  const double drift = at.along * c.sigma + at.up * height;
  // the mean height of a bounce times P'; v is that of its beginning, of which the flow is less later on
  const double lift = (1.0 - free_) * at.squeeze * v2;
  if (geometric_) {
    const double change = adiabatic - (1.0 - gamma_) * bounces;
    return {on_guide * change, bounces * per_mean_ + even_ * change, sigma, p, drift,
            lift * (3.0 / (1.0 + gamma_ + gamma_ * gamma_))};
  }
  const double w = loss_ * v, delay = at.squeeze * at.per_P * v * w * (1.0 / 3.0 + 0.5 * w), per_T = series_1_over_T(w);
  const double change = adiabatic * per_T * (1.0 - 0.5 * w * w) - w * (bounces * series_R(w) + v * at.lag);
  return {change, bounces * per_T * (1.0 - delay) + even_ * per_v * change, sigma, p, drift, lift * (1.0 + w)};
}

AFM_MULTIVERSION ChatterSurroundings ChatterRates::surroundings(const SlidePiece<double>& guide, double s) const {
  return look(guide.at(s), guide.pressure_jet(s));
}

AFM_MULTIVERSION ChatterAhead ChatterRates::ahead(const SlidePiece<double>& guide, double s, double dt) const {
  const double middle = s + dt / 2.0, end = s + dt;
  const auto pressure = guide.pressure_jets(std::array<double, 2>{middle, end});
  return {look(guide.at(middle), pressure[0]), look(guide.at(end), pressure[1])};
}

AFM_MULTIVERSION EvenChatter ChatterRates::operator()(const ChatterSurroundings& at, const EvenChatter& c) const {
  return rate(at, c);
}

AFM_MULTIVERSION EvenChatter ChatterRates::step(double dt, const EvenChatter& k1, const ChatterAhead& ahead,
                                                const EvenChatter& c) const {
  const EvenChatter k2 = rate(ahead.middle, c + dt / 2.0 * k1);
  const EvenChatter k3 = rate(ahead.middle, c + dt / 2.0 * k2);
  const EvenChatter k4 = rate(ahead.end, c + dt * k3);
  return c + dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
}

AFM_MULTIVERSION SlideState<double> moved_guide(const Model& model, const SlideState<double>& guide,
                                                const Chatter& chatter) {
  const auto N = [&](double phase) { return std::sqrt(1.0 + square(surface_jet(model.H, phase).h1)); };
  const double here = N(guide.phase), dx = chatter.sigma / here;
  return {guide.phase + dx, guide.X + dx, (guide.u * here + chatter.p) / N(guide.phase + dx)};
}

}  // namespace afm
