#include "afm/detail/chatter_rates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/detail/multiversion.h"
#include "chatter_flow.h"
#include "chatter_geometry.h"
#include "four.h"
#include "portable_exp.h"
#include "projection.h"

namespace afm {
namespace {

double mean_over_first(double gamma) {
  const double loss = 1.0 - gamma;
  if (loss < 1e-8) return 1.0;
  return gamma > 0.0 ? -portable_log(gamma) / loss : std::numeric_limits<double>::infinity();
}

}  // namespace

ChatterGeometry::ChatterGeometry(const Model& model)
    : H_(model.H),
      wv2_(square(kTwoPi)),
      free_(is_free_along_x(model)),
      wh2_(free_ * square(kTwoPi * model.frequency_ratio)),
      slow_rate_(std::max(1.0, free_ * model.frequency_ratio)) {}

ChatterRates::ChatterRates(const Model& model, bool geometric)
    : view_(model), flow_{geometric,   view_.held(),
                          model.gamma, geometric ? 0.0 : (1.0 - model.gamma) / model.v_c,
                          0.0,         1.0 / mean_over_first(model.gamma)} {
  // no more than rounding allows where the loss is next to nothing: then n alone changes evenly
  constexpr double kLeastLoss = 1e-4;
  const double loss = geometric ? 1.0 - model.gamma : flow_.loss;
  flow_.even = loss > kLeastLoss ? (geometric ? flow_.inverse_mean : 1.0) / loss : 0.0;
}

double ChatterRates::x_of(double v) const { return smooth_speed(flow_, v); }

// n without that much more of its part in 1/v.
AFM_INLINED void ChatterRates::take_part(double more, SmoothChatter& even, SmoothChatter& rate) const {
  if (flow_.geometric || more == 0.0) return;
  const double bounces = more / chatter_speed(flow_, even.x);
  even.rest -= bounces, rate.rest += bounces * rate.x;
}

double ChatterRates::fall_time(const ChatterSurroundings& at, double v) const {
  return 2.0 * at.inverse_P * (flow_.geometric ? v / (1.0 - flow_.gamma) : 1.0 / flow_.loss);
}

AFM_MULTIVERSION ChatterSurroundings ChatterRates::surroundings(const Flight<double>& bounce) const {
  return view_.look(bounce);
}

AFM_MULTIVERSION ChatterSurroundings ChatterRates::surroundings(const SlideSegment<double>& reference, double s) const {
  return view_.look(reference, s);
}

AFM_MULTIVERSION bool ChatterRates::certainly_outlasts(const Flight<double>& bounce, double part) const {
  return view_.certainly_outlasts(bounce, part);
}

AFM_MULTIVERSION ChatterPlace ChatterRates::begin(const SlideSegment<double>& reference, double s,
                                                  const Chatter& start) const {
  ChatterPlace at{s, view_.look(reference, s), {}, {}, start, flow_.even};
  at.even = to_smooth(flow_, at.around, at.part, start);
  at.rate = chatter_rate(flow_, at.around, at.part, at.even);
  return at;
}

AFM_MULTIVERSION ChatterPlace ChatterRates::step(const SlideSegment<double>& reference, const ChatterPlace& from,
                                                 double dt) const {
  constexpr double kMuchFall = 1.5;  // of ln v, over which n grows too unevenly
  constexpr double kBrief = 1e-5;    // differences over dt of what is seen at its ends would be noise
  // two functions, as one that returns either would copy what it has just written
  const auto by_nodes = [&] {
    const double part = dt > kMuchFall * fall_time(from.around, from.plain.v) ? flow_.even : 0.0;
    ChatterPlace to{from.s + dt, view_.look(reference, from.s + dt), from.even, from.rate, {}, part};
    take_part(part - from.part, to.even, to.rate);
    node_step<Four>(flow_, from, dt, to);
    to.plain = to_plain(flow_, to.around, to.part, to.even);
    return to;
  };
  const bool brief = dt * std::max(from.around.relative_rate, from.around.slow_rate) < kBrief;
  return brief ? brief_step(reference, from, dt) : by_nodes();
}

AFM_MULTIVERSION ChatterPlace ChatterRates::brief_step(const SlideSegment<double>& reference, const ChatterPlace& from,
                                                       double dt) const {
  ChatterPlace to{from.s + dt, view_.look(reference, from.s + dt), {}, {}, {}, from.part};
  to.rate = chatter_rate(flow_, to.around, to.part, from.even + dt * from.rate);
  to.even = from.even + 0.5 * dt * (from.rate + to.rate);
  to.plain = to_plain(flow_, to.around, to.part, to.even);
  return to;
}

AFM_MULTIVERSION Chatter ChatterRates::after(const ChatterPlace& from, double dt) const {
  return to_plain(flow_, from.around, from.part, from.even + dt * from.rate);
}

AFM_MULTIVERSION SlideState<double> moved_reference(const Model& model, const SlideState<double>& reference,
                                                const Chatter& chatter) {
  return moved_reference_of(model.H, reference, chatter);
}

}  // namespace afm
