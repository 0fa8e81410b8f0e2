// The books of a tip's energy: the drag works only through the springs, so what is lost is what it put in, less what is
// stored.
#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "afm/reflection.h"
#include "afm/surface.h"
#include "afm/tip.h"

namespace afm {

// In the springs and in motion over the ground [m a^2/tau^2].
inline double stored_energy(const Model& m, const FreeState& s) {
  const double omega_h = kTwoPi * m.frequency_ratio, Y = s.y - m.y0;
  return 0.5 * (s.u * s.u + s.w * s.w + omega_h * omega_h * s.X * s.X + kTwoPi * kTwoPi * Y * Y);
}

// Horizontal velocity before an impact.
inline double incident_u(const Model& m, const Impact& impact) {
  const double slope = surface_jet(m.H, impact.surface_phase).h1;
  return (impact.tangential_velocity + slope * impact.normal_speed) / std::sqrt(1.0 + slope * slope);
}

class EnergyLedger {
 public:
  // `tip` starts in the air.
  EnergyLedger(const Model& model, const Tip& tip) : model_(model), at_start_(stored_energy(model, tip.state())) {}

  // Tip::advance_arc, entered in the books.
  Outcome advance_arc(Tip& tip, const ModelTime& limit) {
    const bool on_guide = bursting_ || tip.in_contact();
    if (on_guide) work_ += work_on_guide(tip, limit);
    const double u = tip.tip_state().u, eta = tip.eta();
    const Outcome outcome = tip.advance_arc(limit);
    const bool bounced = outcome == Outcome::impact && tip.last_impact().kind == ImpactKind::impact;
    // in a flight the force of the spring is the change of u
    if (!on_guide) work_ += eta * ((bounced ? incident_u(model_, tip.last_impact()) : tip.tip_state().u) - u);
    if (outcome == Outcome::impact) enter_impact(tip);
    return outcome;
  }

  // Tip::retune, entered in the books: who lifts the centre stretches the spring by as much.
  void retune(Tip& tip, const Model& model) {
    tip.retune(model);
    work_ += stored_energy(model, tip.state()) - stored_energy(model_, tip.state());
    model_ = model;
  }

  // Energy from nothing, and what it is to be compared with: all that has been turned over.
  double imbalance(const Tip& tip) const {
    return static_cast<double>(lost_ - work_ - tip.work_off_guide()) +
           (stored_energy(model_, tip.state()) + in_bounces_ - at_start_);
  }
  double turnover(const Tip& tip) const {
    return static_cast<double>(gross_) + stored_energy(model_, tip.state()) + at_start_;
  }
  double lost() const { return static_cast<double>(lost_); }
  bool bursting() const { return bursting_; }

 private:
  void enter_impact(const Tip& tip) {
    const Impact& impact = tip.last_impact();
    lost_ += impact.energy_loss;
    gross_ += std::abs(impact.energy_loss);
    // in a burst the state is that of the guide, without the bounces
    const double after = restitution(model_, impact.normal_speed) * impact.normal_speed;
    bursting_ = impact.kind == ImpactKind::impact && tip.in_burst();
    in_bounces_ = bursting_ ? 0.5 * after * after : 0.0;
  }

  double work_on_guide(Tip& tip, const ModelTime& limit) const {
    const ModelTime now = tip.now(), end = limit < tip.arc_end() ? limit : tip.arc_end();
    if (!(now < end)) return 0.0;
    const auto X = [&](double s) { return tip.deflection(now + s).lateral; };
    const double omega_h = kTwoPi * model_.frequency_ratio;
    return -omega_h * omega_h * tip.eta() * boost::math::quadrature::gauss<double, 10>::integrate(X, 0.0, end - now);
  }

  Model model_;
  double at_start_, in_bounces_ = 0.0;
  long double work_ = 0.0L, lost_ = 0.0L, gross_ = 0.0L;
  bool bursting_ = false;
};

}  // namespace afm
