#include "afm/dynamics/tangents.h"

#include <cmath>
#include <limits>

#include "afm/flight.h"
#include "afm/reflection.h"
#include "contact_jacobian.h"
#include "core/run/interruptible_advance.h"

namespace afm {

using namespace detail;

namespace {

SlideState<double> slide_state_of(const TipState& s) { return {s.phase, s.X, s.u}; }

}  // namespace

// The hammer has two displacements, of phase and gap rate.
Tangents::Tangents(const Model& model, Tip& tip)
    : model_(model), springs_(model), tip_(tip), rank_(section_dimension(model)) {
  if (rank_ == 2) columns_.col(1).swap(columns_.col(3));
}

bool Tangents::start(double within) {
  const ModelTime end = tip_.now() + within;
  while (!tip_.in_contact()) {
    const ModelTime before = tip_.now();
    const TipState launch = tip_.tip_state();
    const Outcome outcome = advance_interruptibly(tip_, end);
    if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) return false;
    if (outcome != Outcome::impact || tip_.last_impact().kind != ImpactKind::impact) continue;
    const GapJet<double> landing = Flight<double>(springs_, tip_.eta(), launch).gap(tip_.now() - before);
    restart(reflect(model_, tip_.eta(), landing).after);
    return true;
  }
  start_ = tip_.tip_state();
  since_ = tip_.now();
  begin_contact();
  return true;
}

Outcome Tangents::advance(const ModelTime& limit) {
  // [tau] a choice: displacements grow by some factors of e in it, and stay apart
  constexpr double kLongestSlide = 1.0;
  growth_ = {};
  const ModelTime cut = tip_.now() + kLongestSlide;
  const bool is_cut = tip_.in_contact() && cut < limit;
  const Outcome outcome = advance_interruptibly(tip_, is_cut ? cut : limit);
  const double dt = tip_.now() - since_;
  if (outcome == Outcome::time_limit) {
    if (tip_.in_contact()) carry_slide(dt);  // other segments count when they end
    if (is_cut) return Outcome::flying;
  } else if (outcome == Outcome::impact) {
    tip_.last_impact().kind == ImpactKind::burst ? carry_chatter(dt) : carry_bounce(dt);
  } else if (outcome == Outcome::contact) {
    begin_contact();
  } else if (outcome == Outcome::released) {
    carry_slide(dt);
  }
  return outcome;
}

// Computes the flight from impact to impact again, with its Jacobian.
void Tangents::carry_bounce(double dt) {
  const Flight<double> flight(springs_, tip_.eta(), start_);
  GapJet<double> landing = flight.gap(dt);
  landing.g1 = std::fmin(landing.g1, -std::numeric_limits<double>::min());
  const Reflection bounce = reflect(model_, tip_.eta(), landing);
  const RestitutionJet<double> law = restitution_jet(model_, bounce.normal_speed);
  const bool is_plastic = law.slope == 0.0;  // all gap rates become one
  if (is_plastic) rank_ = std::min(rank_, section_dimension(model_) - 1);
  carry(section_jacobian(model_, flight, dt, landing));
  growth_.volume = is_plastic ? -std::numeric_limits<double>::infinity()
                              : std::log(std::abs(law.slope) * law.restitution * start_.g1 / bounce.after.g1);
  restart(bounce.after);
}

// From the state of the tip: that of `bounce` differs by rounding, which an unstable orbit would amplify. A tip that
// has begun a chatter sequence shows only its reference slide; then we use `bounce`.
void Tangents::restart(const TipState& bounce) {
  start_ = tip_.in_flight() ? tip_.tip_state() : bounce;
  since_ = tip_.now();
}

// A sequence that dies ends on the reference slide, without a normal velocity; contact follows.
void Tangents::carry_chatter(double dt) {
  const TipState end = tip_.tip_state();
  growth_.volume = std::numeric_limits<double>::quiet_NaN();
  if (end.g1 > 0.0) {
    carry(chatter_jacobian(model_, ChatterLaw(model_, tip_.contact_tolerance()), tip_.eta(), start_, dt));
  } else {
    SectionJacobian<double> J = projection_jacobian(model_, start_);
    J.topRows<3>() =
        slide_jacobian(model_, tip_.eta(), project_onto_surface(model_, start_).reference, dt) * J.topRows<3>().eval();
    J.row(3).setZero();
    J = without_held_directions(springs_.is_free_along_x, J);
    columns_ = J * columns_;
    jacobian_ = J;
  }
  start_ = end;
  since_ = tip_.now();
}

void Tangents::begin_contact() {
  const SlideState<double> reference = project_onto_surface(model_, start_).reference;
  SectionJacobian<double> J = without_held_directions(springs_.is_free_along_x, projection_jacobian(model_, start_));
  J.row(3).setZero();
  const Eigen::Vector3d F = slide_velocity(model_, tip_.eta(), reference).normalized();
  columns_ = J * columns_;
  columns_.topRows<3>() -= F * (F.transpose() * columns_.topRows<3>()).eval();
  jacobian_ = J;
  rank_ = std::min(rank_, section_dimension(model_) - 2);
  orthonormalize();
  start_ = tip_.tip_state();
  since_ = tip_.now();
}

void Tangents::carry_slide(double dt) {
  SectionJacobian<double> J = SectionJacobian<double>::Zero();
  J.topLeftCorner<3, 3>() = slide_jacobian(model_, tip_.eta(), slide_state_of(start_), dt);
  start_ = tip_.tip_state();
  since_ = tip_.now();
  columns_ = J * columns_;
  const Eigen::Vector3d F = slide_velocity(model_, tip_.eta(), slide_state_of(start_)).normalized();
  columns_.topRows<3>() -= F * (F.transpose() * columns_.topRows<3>()).eval();
  jacobian_ = J;
  orthonormalize();
}

void Tangents::carry(const SectionJacobian<double>& J) {
  jacobian_ = J;
  columns_ = J * columns_;
  orthonormalize();
}

// Gram-Schmidt, two passes: after a graze the columns are nearly parallel.
void Tangents::orthonormalize() {
  for (int j = 0; j < rank_; ++j) {
    double length = 1.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (int k = 0; k < j; ++k) columns_.col(j) -= columns_.col(k).dot(columns_.col(j)) * columns_.col(k);
      const double part = columns_.col(j).norm();
      length *= part;
      if (part > 0.0) columns_.col(j) /= part;
    }
    growth_.logarithms[static_cast<std::size_t>(j)] += std::log(length);
  }
  columns_.rightCols(4 - rank_).setZero();
}

}  // namespace afm
