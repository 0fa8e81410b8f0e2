// Jacobians of contact and chatter. In contact two of the four directions of the section are left: the normal velocity
// is gone, and with it the time of the next bounce. A displacement is then (dx, dX, du) of the slide, and its part
// along the slide does not count. The hammer's slide has only that part, so no displacement is left.
#pragma once

#include <Eigen/Core>

#include "afm/detail/chatter.h"
#include "afm/detail/slide_segment.h"
#include "afm/dynamics/jacobian.h"
#include "afm/flight.h"
#include "afm/model.h"

namespace afm::detail {

// A slide of duration s [tau] from `start`, released or not: the exact derivative of its Taylor series.
Eigen::Matrix3d slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s);

// d(x, X, u)/dt of a slide, the direction that does not count.
Eigen::Vector3d slide_velocity(const Model& model, double eta, const SlideState<double>& q);

// The derivative of project_onto_surface() (chatter.h), the reference slide and the normal speed, by dx, dX, du, dg1.
Eigen::Matrix4d projection_jacobian(const Model& model, const TipState& bounce);

// The derivative of a chatter sequence that exits: from `start`, after its first bounce, to after its last, `duration`
// later [tau]. It is the derivative of the averaged law. The error of the law for each bounce adds up. Against the
// exact chain of up to 400 bounces half of all sequences have an error below 1.4e-4 (the hammer: 8.4e-4), and all below
// 8e-3 (test chatter_jacobian).
SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                         double duration);

}  // namespace afm::detail
