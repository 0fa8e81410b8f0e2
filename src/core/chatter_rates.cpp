#include "afm_emulator/chatter_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "afm_emulator/multiversion.h"
#include "chatter_look.h"
#include "portable_exp.h"

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

AFM_INLINED double even_speed(bool geometric, double v) { return geometric ? v : portable_log(v); }

double mean_over_first(double gamma) {
  const double loss = 1.0 - gamma;
  if (loss < 1e-8) return 1.0;
  return gamma > 0.0 ? -portable_log(gamma) / loss : std::numeric_limits<double>::infinity();
}

// The reaction off the guide over that on it, less 1. The action keeps v^3/P.
AFM_INLINED double disturbance(const ChatterSurroundings& at, double sigma, double p) {
  return std::fma(2.0 * at.turn, p, -at.lean * sigma) * at.per_P;
}

// start and the integrals over dt to node i: of the rates at the beginning and at the nodes.
AFM_INLINED EvenChatter collocated(std::size_t i, double dt, const EvenChatter& start, const EvenChatter& first,
                                   const EvenChatter (&rates)[4]) {
  const std::array<double, 5>& w = kLobatto[i];
  const auto sum = [&](double EvenChatter::*of) {
    double x = std::fma(dt * w[0], first.*of, start.*of);
#pragma GCC unroll 4
    for (std::size_t k = 0; k < 4; ++k) x = std::fma(dt * w[k + 1], rates[k].*of, x);
    return x;
  };
  return {sum(&EvenChatter::x), sum(&EvenChatter::rest),  sum(&EvenChatter::sigma),
          sum(&EvenChatter::p), sum(&EvenChatter::drift), sum(&EvenChatter::lift)};
}

}  // namespace

ChatterView::ChatterView(const Model& model)
    : H_(model.H),
      wv2_(square(kTwoPi)),
      free_(mobility(model)),
      wh2_(free_ * square(kTwoPi * model.frequency_ratio)),
      slow_rate_(std::max(1.0, free_ * model.frequency_ratio)) {}

ChatterRates::ChatterRates(const Model& model, bool geometric)
    : view_(model),
      geometric_(geometric),
      gamma_(model.gamma),
      loss_(geometric ? 0.0 : (1.0 - model.gamma) / model.v_c),
      per_mean_(1.0 / mean_over_first(model.gamma)) {
  // no more than rounding allows where the loss is next to nothing: then n alone changes evenly
  constexpr double kLeastLoss = 1e-4;
  const double loss = geometric ? 1.0 - gamma_ : loss_;
  even_ = loss > kLeastLoss ? (geometric ? per_mean_ : 1.0) / loss : 0.0;
}

AFM_INLINED double ChatterRates::speed(double x) const {
  return geometric_ ? std::max(x, std::numeric_limits<double>::min()) : portable_exp(x);
}

double ChatterRates::x_of(double v) const { return even_speed(geometric_, v); }

AFM_INLINED double ChatterRates::bounces_at(double v) const {
  return geometric_ ? -even_ * portable_log(v) : even_ / v;
}

AFM_INLINED EvenChatter ChatterRates::even(const ChatterSurroundings& at, const Chatter& c) const {
  const double v = c.v * std::fma(-kThird, disturbance(at, c.sigma, c.p), 1.0);
  return {even_speed(geometric_, v), c.n - bounces_at(v), c.sigma, c.p, c.drift, c.lift};
}

AFM_INLINED Chatter ChatterRates::plain(const ChatterSurroundings& at, const EvenChatter& c) const {
  const double v = speed(c.x);
  return {
      v * std::fma(kThird, disturbance(at, c.sigma, c.p), 1.0), c.rest + bounces_at(v), c.sigma, c.p, c.drift, c.lift};
}

double ChatterRates::fall_time(const ChatterSurroundings& at, double v) const {
  return 2.0 * at.per_P * (geometric_ ? v / (1.0 - gamma_) : 1.0 / loss_);
}

// Products of two terms of the second order are left out: what is kept is no better.
AFM_INLINED EvenChatter ChatterRates::rate(const ChatterSurroundings& at, const EvenChatter& c) const {
  const double on_guide = speed(c.x), per_v = 1.0 / on_guide;
  const double more = disturbance(at, c.sigma, c.p), v = std::fma(on_guide, kThird * more, on_guide), v2 = v * v;
  const double height = v2 * (kThird * at.per_P), longer = at.stretch * v2,
               shorter = std::fma(-longer, 1.0 - longer, 1.0);
  const double even = 0.5 * at.P * shorter, bounces = per_v * std::fma(even, 2.0 * kThird * more, even);
  const double adiabatic = std::fma(at.squeeze, shorter, at.twist * v2);  // of ln v, as are those below
  const double sigma = std::fma(2.0 * at.turn, height, c.p), p = std::fma(at.lean, height, -at.stiffness * c.sigma);
  const double drift = std::fma(at.along, c.sigma, at.up * height);
  // the mean height of a bounce times P'; v is that of its beginning, of which the flow is less later on
  const double lift = (view_.held() ? at.squeeze : 0.0) * v2;
  if (geometric_) {
    const double change = std::fma(gamma_ - 1.0, bounces, adiabatic);
    return {on_guide * change,
            std::fma(bounces, per_mean_, even_ * change),
            sigma,
            p,
            drift,
            lift * (3.0 / (1.0 + gamma_ + gamma_ * gamma_))};
  }
  const double w = loss_ * v, delay = at.squeeze * at.per_P * v * w * std::fma(w, 0.5, kThird),
               per_T = series_1_over_T(w);
  const double change =
      std::fma(adiabatic * per_T, std::fma(-0.5 * w, w, 1.0), -w * std::fma(bounces, series_R(w), v * at.lag));
  return {
      change, std::fma(bounces * per_T, 1.0 - delay, even_ * per_v * change), sigma, p, drift, std::fma(lift, w, lift)};
}

AFM_MULTIVERSION ChatterSurroundings ChatterRates::surroundings(const Flight<double>& bounce) const {
  return view_.look(bounce);
}

AFM_MULTIVERSION bool ChatterRates::outlasts(const Flight<double>& bounce, double part) const {
  return view_.outlasts(bounce, part);
}

AFM_MULTIVERSION ChatterPlace ChatterRates::begin(const SlidePiece<double>& guide, double s,
                                                  const Chatter& start) const {
  ChatterPlace at{s, view_.look(guide, s), {}, {}, start};
  at.even = even(at.around, start);
  at.rate = rate(at.around, at.even);
  return at;
}

// Over so little that differences over dt of what is seen at its ends would be noise: by the mean of two rates.
AFM_INLINED void ChatterRates::brief(const ChatterPlace& from, double dt, ChatterPlace& to) const {
  to.rate = rate(to.around, from.even + dt * from.rate);
  to.even = from.even + 0.5 * dt * (from.rate + to.rate);
}

// From what the first rate foretells, twice: it leaves a few parts in 1e6 of what a step changes. The rate at its end is
// that of the first time, near enough for the next step, which gives it a twentieth of the weight.
AFM_INLINED void ChatterRates::long_step(const ChatterPlace& from, double dt, ChatterPlace& to) const {
  const ChatterSurroundings& end = to.around;
  const ChatterSurroundings at[4] = {view_.between(from.around, end, dt, 0), view_.between(from.around, end, dt, 1),
                                     view_.between(from.around, end, dt, 2), end};
  EvenChatter rates[4];
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) rates[k] = rate(at[k], from.even + kNodes[k] * dt * from.rate);
  EvenChatter c[4];
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) c[k] = collocated(k, dt, from.even, from.rate, rates);
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) rates[k] = rate(at[k], c[k]);
  to.even = collocated(3, dt, from.even, from.rate, rates);
  to.rate = rates[3];
}

AFM_MULTIVERSION ChatterPlace ChatterRates::step(const SlidePiece<double>& guide, const ChatterPlace& from,
                                                 double dt) const {
  constexpr double kBrief = 1e-5;
  ChatterPlace to{from.s + dt, view_.look(guide, from.s + dt), {}, {}, {}};
  const bool soon = dt * std::max(from.around.quickness, from.around.slow_rate) < kBrief;
  soon ? brief(from, dt, to) : long_step(from, dt, to);
  to.plain = plain(to.around, to.even);
  return to;
}

AFM_MULTIVERSION ChatterPlace ChatterRates::brief_step(const SlidePiece<double>& guide, const ChatterPlace& from,
                                                       double dt) const {
  ChatterPlace to{from.s + dt, view_.look(guide, from.s + dt), {}, {}, {}};
  brief(from, dt, to);
  to.plain = plain(to.around, to.even);
  return to;
}

AFM_MULTIVERSION Chatter ChatterRates::after(const ChatterPlace& from, double dt) const {
  return plain(from.around, from.even + dt * from.rate);
}

AFM_MULTIVERSION SlideState<double> moved_guide(const Model& model, const SlideState<double>& guide,
                                                const Chatter& chatter) {
  const auto N = [&](double phase) { return std::sqrt(1.0 + square(surface_jet(model.H, phase).h1)); };
  const double here = N(guide.phase), dx = chatter.sigma / here;
  return {guide.phase + dx, guide.X + dx, (guide.u * here + chatter.p) / N(guide.phase + dx)};
}

}  // namespace afm
