// Tangent vectors along the orbit of a tip, kept orthonormal, and their growth at each event (Eq. 5 of the paper for an
// impact).
#pragma once

#include <Eigen/Core>
#include <array>

#include "afm/model.h"
#include "afm/tip.h"
#include "jacobian.h"

namespace afm {

// Natural logarithms of the growth in one event; in the long run the largest is first.
struct EventGrowth {
  std::array<double, 4> logarithms{};
  double volume = 0.0;  // their sum, from the restitution alone; NaN over a chatter sequence
};

class Tangents {
 public:
  // Precondition: only advance() moves the tip from now on.
  Tangents(const Model& model, Tip& tip);

  // To the first impact or contact, from which the displacements can be followed. False if there is none `within`
  // [tau].
  bool start(double within);

  // To the tip's next event, or to the limit. In contact at most 1 tau: Outcome::flying, which is no event.
  Outcome advance(const ModelTime& limit);

  const EventGrowth& growth() const { return growth_; }  // of the last advance
  // Derivative of the last event, on the section. In contact its first three rows and columns are those of the slide.
  const SectionJacobian<double>& jacobian() const { return jacobian_; }
  ModelTime carried_to() const { return since_; }
  int rank() const { return rank_; }

 private:
  void restart(const TipState& bounce);
  void carry_bounce(double dt);
  void carry_chatter(double dt);
  void carry_slide(double dt);
  void begin_contact();
  void carry(const SectionJacobian<double>& J);
  void orthonormalize();

  const Model model_;
  const SpringConstants<double> springs_;
  Tip& tip_;
  TipState start_;  // of the segment under way
  ModelTime since_;
  Eigen::Matrix4d columns_ = Eigen::Matrix4d::Identity();
  SectionJacobian<double> jacobian_ = Eigen::Matrix4d::Identity();
  int rank_;
  EventGrowth growth_;
};

}  // namespace afm
