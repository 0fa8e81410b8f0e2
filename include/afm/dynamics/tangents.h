// Displacements that travel with a tip, kept orthonormal: what each event of the tip has stretched them by.
#pragma once

#include <Eigen/Core>
#include <array>

#include "jacobian.h"
#include "afm/model.h"
#include "afm/tip.h"

namespace afm {

// Natural logarithms of one event's stretching, largest growth first in the long run.
struct Stretch {
  std::array<double, 4> logarithms{};
  double volume = 0.0;  // their sum as the restitution alone gives it; NaN over a burst
};

class Tangents {
 public:
  // The tip is moved by advance(), and by nothing else meanwhile.
  Tangents(const Model& model, Tip& tip);

  // To the first event after which the displacements are known: an impact, or a slide under way. False where none
  // comes.
  bool start(double within);

  // To the tip's next event, or to the limit.
  Outcome advance(const ModelTime& limit);

  const Stretch& stretch() const { return stretch_; }  // of the last advance
  const SectionJacobian<double>& jacobian() const {
    return jacobian_;
  }  // of the last event [section, or slide in its first three]
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
  const Mechanics<double> mechanics_;
  Tip& tip_;
  TipState start_;  // of the arc under way
  ModelTime since_;
  Eigen::Matrix4d columns_ = Eigen::Matrix4d::Identity();
  SectionJacobian<double> jacobian_ = Eigen::Matrix4d::Identity();
  int rank_;
  Stretch stretch_;
};

}  // namespace afm
