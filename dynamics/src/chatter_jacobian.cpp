// A chatter sequence in dual numbers, which carry their derivatives by the state after its first bounce. The law is
// that of the tip (chatter_bounce.h, chatter_flow.h); the steps are taken separately.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "afm/detail/dual.h"
#include "afm/dynamics/contact_jacobian.h"
#include "core/contact/chatter_bounce.h"
#include "core/contact/chatter_flow.h"
#include "core/contact/chatter_geometry.h"
#include "core/contact/projection.h"
#include "section_duals.h"

namespace afm {

template <std::size_t N>
Dual<N> portable_exp(const Dual<N>& x) {
  const double value = portable_exp(x.value);
  return chain(value, value, x);
}
template <std::size_t N>
Dual<N> portable_log(const Dual<N>& x) {
  return chain(portable_log(x.value), 1.0 / x.value, x);
}

namespace {

// Length of a step of the classical Runge-Kutta method, as a part of the shortest of three times: v falls by the factor
// e, the reaction changes, the reaction swings with the horizontal spring. We measured: a third of it changes the
// Jacobian by 1e-4 of itself at most, a tenth of the error of the law (test chatter_jacobian).
constexpr double kRungeKuttaStep = 0.15;
// More would be an error: we counted up to 80 over sequences at eta 0.5 to 9 and cutoffs of 0.003 and 0.05.
constexpr int kMaxRungeKuttaSteps = 20000;

class ChatterSequence {
 public:
  ChatterSequence(const Model& model, const ChatterLaw& law, double eta, const TipState& start)
      : law_(law),
        flow_(law.rates().flow()),
        free_(is_free_along_x(model)),
        mechanics_(model),
        eta_(eta),
        reference_(mechanics_, eta_, first(start).reference),
        chatter_{first(start).normal_speed, Dual4(0.0)} {}

  // To the bounce that ends about `duration` after the start; returns the state after it.
  Bounce4<Dual4> run(double duration) {
    left_ = duration;
    while (law_.takes_single_bounces(chatter_.v.value) && bounce()) {
    }
    if (left_ > 0.5 * last_bounce_) average();
    return launched(free_, mechanics_.H, moved_reference_of(mechanics_.H, reference_.at(s_), chatter_), chatter_.v);
  }

 private:
  ProjectedOf<Dual4> first(const TipState& s) const { return projected(free_, mechanics_.H, section_variables(s)); }

  ChatterSurroundingsOf<Dual4> surroundings(const Dual4& s) const {
    return law_.rates().geometry().surroundings(reference_, s);
  }

  // A new Taylor series of the reference slide begins where the chatter has moved the tip, as in Tip.
  void begin_segment() {
    const SlideState<Dual4> moved = moved_reference_of(mechanics_.H, reference_.at(s_), chatter_);
    reference_ = SlideSegment<Dual4>(mechanics_, eta_, moved);
    chatter_ = {chatter_.v, chatter_.n};
    s_ = Dual4(0.0);
  }

  // One bounce by itself. False if it would end after the sequence.
  bool bounce() {
    if (s_.value > 0.5 * reference_.length().value) begin_segment();
    const ChatterSurroundingsOf<Dual4> at = surroundings(s_);
    const Reaction<Dual4> reaction = later(at, Dual4(0.0));
    const BounceArc<Dual4> arc = arc_of(reaction, at, chatter_.v);
    last_bounce_ = arc.duration.value;
    if (!(0.5 * last_bounce_ < left_)) return false;
    chatter_ = moved(at, reaction, arc.duration, flow_.is_held_along_x, chatter_);
    chatter_.v = speed_after(law_.max_loss(), flow_, arc.speed);
    chatter_.n = chatter_.n + Dual4(1.0);
    s_ = s_ + arc.duration;
    left_ -= last_bounce_;
    return true;
  }

  // The averages, over the time that is left. Neighbouring starts end with the same bounce, not at the same time: so
  // the last step goes to a fixed n.
  void average() {
    SmoothChatterOf<Dual4> smooth{};
    for (int i = 0; i < kMaxRungeKuttaSteps && left_ > 0.0; ++i) {
      begin_segment();
      smooth = to_smooth(flow_, surroundings(s_), flow_.n_per_inverse_v, chatter_);
      const double dt = std::min(left_, step_length());
      smooth = runge_kutta(smooth, dt);
      s_ = Dual4(dt), left_ -= dt;
      chatter_ = from_smooth(flow_, surroundings(s_), flow_.n_per_inverse_v, smooth);
    }
    if (left_ > 0.0) smooth.x = Dual4(std::numeric_limits<double>::quiet_NaN());  // makes the whole result NaN
    const SmoothChatterOf<Dual4> rates = rate(s_.value, smooth);
    const Dual4 late = lateness(bounce_rate(smooth, rates));
    s_ = s_ + late;
    chatter_ = from_smooth(flow_, surroundings(s_), flow_.n_per_inverse_v, smooth + late * rates);
  }

  double step_length() const {
    const ChatterSurroundingsOf<Dual4> at = surroundings(s_);
    const double P = at.P.value, v = chatter_.v.value;
    const double fall = 2.0 / P * (flow_.geometric ? v / law_.max_loss() : 1.0 / flow_.loss);
    const double changes = std::max(at.relative_rate.value, 2.0 * kTwoPi * at.slow_rate.value);
    return std::min(kRungeKuttaStep * std::min(fall, 1.0 / changes), reference_.length().value);
  }

  SmoothChatterOf<Dual4> rate(double s, const SmoothChatterOf<Dual4>& smooth) const {
    return chatter_rate(flow_, surroundings(Dual4(s)), flow_.n_per_inverse_v, smooth);
  }

  SmoothChatterOf<Dual4> runge_kutta(const SmoothChatterOf<Dual4>& c, double dt) const {
    const SmoothChatterOf<Dual4> k1 = rate(0.0, c), k2 = rate(0.5 * dt, c + Dual4(0.5 * dt) * k1);
    const SmoothChatterOf<Dual4> k3 = rate(0.5 * dt, c + Dual4(0.5 * dt) * k2), k4 = rate(dt, c + Dual4(dt) * k3);
    return c + Dual4(dt / 6.0) * (k1 + Dual4(2.0) * (k2 + k3) + k4);
  }

  // dn/dt, the rate of `rest` and of the part of n that depends on v.
  double bounce_rate(const SmoothChatterOf<Dual4>& smooth, const SmoothChatterOf<Dual4>& rates) const {
    const Dual<1> x = chain(smooth.x.value, rates.x.value, Dual<1>::variable(0.0, 0));
    return rates.rest.value + bounces_at(flow_, flow_.n_per_inverse_v, chatter_speed(flow_, x)).by[0];
  }

  // How much later the last bounce comes: the derivative alone, as its value is zero.
  Dual4 lateness(double rate_of_n) const { return chain(0.0, -1.0 / rate_of_n, chatter_.n); }

  const ChatterLaw& law_;
  const ChatterFlow& flow_;
  const Dual4 free_;
  const Mechanics<Dual4> mechanics_;
  const Dual4 eta_;
  SlideSegment<Dual4> reference_;
  Dual4 s_{0.0};  // since the start of reference_ [tau]
  ChatterOf<Dual4> chatter_;
  double left_ = 0.0, last_bounce_ = 0.0;  // [tau]
};

}  // namespace

SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                         double duration) {
  const Bounce4<Dual4> end = ChatterSequence(model, law, eta, start).run(duration);
  return without_held_directions(is_free_along_x(model), derivatives<4>({end.phase, end.X, end.u, end.g1}));
}

}  // namespace afm
