// How displacements are carried where the surface holds the tip. Of the four directions of a section two are left in
// contact: the normal velocity is gone, and with it the time at which the last bounce would have been. A displacement
// is then one of the slide, (dx, dX, du), of which the part along the slide itself does not count. The hammer's slide
// has no other part: nothing is left of a displacement.
#pragma once

#include <Eigen/Core>

#include "afm/chatter.h"
#include "afm/flight.h"
#include "jacobian.h"
#include "afm/model.h"
#include "afm/contact.h"

namespace afm {

using SlideJacobian = Eigen::Matrix3d;

// A slide of duration s [tau] from `start`, released or not: exact derivative of its Taylor series, piece after piece.
SlideJacobian slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s);

// d(x, X, u)/dt of a slide: the direction that does not count.
Eigen::Vector3d slide_velocity(const Model& model, double eta, const SlideState<double>& q);

// The guide and the normal speed (project_onto_surface() of chatter.h) by the state after a bounce: by dx, dX, du, dg1.
Eigen::Matrix4d projection_jacobian(const Model& model, const TipState& bounce);

// From after the first bounce of a burst, `start`, to after its last, `duration` later [tau], which leaves a normal
// speed. The derivative of the law by which the tip makes the burst. Against the exact chain of
// its bounces half of all bursts are good to 2e-4, and all that were tried, of up to 3000 bounces, to 8e-3: what the
// law leaves out of each bounce adds up.
SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                       double duration);

}  // namespace afm
