// A burst again, in numbers that carry their derivatives by the state after its first bounce: the law is that of the tip
// (chatter_bounce.h, chatter_flow.h), only the steps are taken otherwise.
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

// A step of the classical Runge-Kutta method, in parts of the times in which the normal speed falls by the factor e, the
// reaction changes, and it swings with the horizontal spring. We measured: a third of it changes the Jacobian by 1e-4 of
// itself at most, a tenth of what the law leaves out.
constexpr double kStep = 0.15;
// Up to 80 steps were counted over bursts at eta 0.5 to 9 and cutoffs of 0.003 and 0.05.
constexpr int kMostSteps = 20000;

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

  // To the bounce that ends about `duration` after the start; the state after it.
  Bounce4<Dual4> run(double duration) {
    left_ = duration;
    while (law_.takes_single_bounces(chatter_.v.value) && bounce()) {
    }
    if (left_ > 0.5 * last_bounce_) average();
    return launched(free_, mechanics_.H, moved_reference_of(mechanics_.H, reference_.at(s_), chatter_), chatter_.v);
  }

 private:
  ProjectedOf<Dual4> first(const TipState& s) const {
    return projected(
        free_, mechanics_.H,
        {Dual4::variable(s.phase, 0), Dual4::variable(s.X, 1), Dual4::variable(s.u, 2), Dual4::variable(s.g1, 3)});
  }

  ChatterSurroundingsOf<Dual4> look(const Dual4& s) const { return law_.rates().view().look(reference_, s); }

  // A new piece of the reference slide begins where the chatter has moved the tip, as the tip does it.
  void begin_segment() {
    reference_ = SlideSegment<Dual4>(mechanics_, eta_, moved_reference_of(mechanics_.H, reference_.at(s_), chatter_));
    chatter_ = {chatter_.v, chatter_.n};
    s_ = Dual4(0.0);
  }

  // One bounce by itself. False where it would end after the burst.
  bool bounce() {
    if (s_.value > 0.5 * reference_.length().value) begin_segment();
    const ChatterSurroundingsOf<Dual4> at = look(s_);
    const Reaction<Dual4> reaction = later(at, Dual4(0.0));
    const BounceArc<Dual4> arc = arc_of(reaction, at, chatter_.v);
    last_bounce_ = arc.duration.value;
    if (!(0.5 * last_bounce_ < left_)) return false;
    chatter_ = moved(at, reaction, arc.duration, flow_.held, chatter_);
    chatter_.v = speed_after(law_.most_loss(), flow_, arc.speed);
    chatter_.n = chatter_.n + Dual4(1.0);
    s_ = s_ + arc.duration;
    left_ -= last_bounce_;
    return true;
  }

  // The averages, over the time that is left; then to the last bounce, which is the same one for every start: to its
  // number, not to one time.
  void average() {
    SmoothChatterOf<Dual4> even{};
    for (int i = 0; i < kMostSteps && left_ > 0.0; ++i) {
      begin_segment();
      even = to_smooth(flow_, look(s_), flow_.even, chatter_);
      const double dt = std::min(left_, step_length());
      even = runge_kutta(even, dt);
      s_ = Dual4(dt), left_ -= dt;
      chatter_ = to_plain(flow_, look(s_), flow_.even, even);
    }
    if (left_ > 0.0) even.x = Dual4(std::numeric_limits<double>::quiet_NaN());  // and so is all that follows
    const SmoothChatterOf<Dual4> rates = rate(s_.value, even);
    const Dual4 late = lateness(bounce_rate(even, rates));
    s_ = s_ + late;
    chatter_ = to_plain(flow_, look(s_), flow_.even, even + late * rates);
  }

  double step_length() const {
    const ChatterSurroundingsOf<Dual4> at = look(s_);
    const double P = at.P.value, v = chatter_.v.value;
    const double fall = 2.0 / P * (flow_.geometric ? v / law_.most_loss() : 1.0 / flow_.loss);
    const double changes = std::max(at.relative_rate.value, 2.0 * kTwoPi * at.slow_rate.value);
    return std::min(kStep * std::min(fall, 1.0 / changes), reference_.length().value);
  }

  SmoothChatterOf<Dual4> rate(double s, const SmoothChatterOf<Dual4>& even) const {
    return chatter_rate(flow_, look(Dual4(s)), flow_.even, even);
  }

  SmoothChatterOf<Dual4> runge_kutta(const SmoothChatterOf<Dual4>& e, double dt) const {
    const SmoothChatterOf<Dual4> k1 = rate(0.0, e), k2 = rate(0.5 * dt, e + Dual4(0.5 * dt) * k1);
    const SmoothChatterOf<Dual4> k3 = rate(0.5 * dt, e + Dual4(0.5 * dt) * k2), k4 = rate(dt, e + Dual4(dt) * k3);
    return e + Dual4(dt / 6.0) * (k1 + Dual4(2.0) * (k2 + k3) + k4);
  }

  // dn/dt, of n = rest + the part that goes with v.
  double bounce_rate(const SmoothChatterOf<Dual4>& even, const SmoothChatterOf<Dual4>& rates) const {
    const Dual<1> x = chain(even.x.value, rates.x.value, Dual<1>::variable(0.0, 0));
    return rates.rest.value + bounces_at(flow_, flow_.even, chatter_speed(flow_, x)).by[0];
  }

  // Of the last bounce: a derivative without a value.
  Dual4 lateness(double rate_of_n) const { return chain(0.0, -1.0 / rate_of_n, chatter_.n); }

  const ChatterLaw& law_;
  const ChatterFlow& flow_;
  const Dual4 free_;
  const Mechanics<Dual4> mechanics_;
  const Dual4 eta_;
  SlideSegment<Dual4> reference_;
  Dual4 s_{0.0};  // since the piece of the guide began
  ChatterOf<Dual4> chatter_;
  double left_ = 0.0, last_bounce_ = 0.0;
};

}  // namespace

SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                       double duration) {
  const Bounce4<Dual4> end = ChatterSequence(model, law, eta, start).run(duration);
  SectionJacobian<double> J;
  const std::array<Dual4, 4> parts{end.phase, end.X, end.u, end.g1};
  for (std::size_t i = 0; i < 4; ++i) {
    J.row(static_cast<Eigen::Index>(i)) << parts[i].by[0], parts[i].by[1], parts[i].by[2], parts[i].by[3];
  }
  return held(is_free_along_x(model), J);
}

}  // namespace afm
