// The next impact in quad precision: what every method's answer is set against.
#pragma once

#include "afm/model.h"
#include "afm/state.h"
#include "trials/quad.h"  // before the templates that find its functions
#include "rivals/method.h"

namespace afm {

struct TrueImpact {
  bool impact;              // false: none within the horizon
  Quad dt, phase, X, u, w;  // after the impact, lab velocities
  TipState after;  // the same in doubles
};

TrueImpact next_impact_in_quad(const Model& model, double eta, const TipState& start, double horizon);

// The largest of the errors in time, phase, extension and velocities after the impact [tau, a, a/tau]. A method whose
// impact took time is compared with the truth as far on.
double error_of(const rivals::Hit& hit, const TrueImpact& truth, const Model& model, double eta);

}  // namespace afm
