// Recognizes a bifurcation of a periodic orbit by its multipliers and impacts.
#pragma once

#include "afm/dynamics/continuation.h"

namespace afm {

// Changes where a bifurcation of the kind is.
int bifurcation_sign(BifurcationKind kind, const PeriodicOrbit& orbit, double v_c);

// Whether an orbit at which the sign changes is one of that kind: multipliers may also jump past the circle, at a
// corner, or a pair may part on the real axis.
bool confirms(BifurcationKind kind, const PeriodicOrbit& orbit);

// Argument of the pair on the unit circle, in turns; 0 where there is none.
double turns_on_circle(const PeriodicOrbit& orbit);

}  // namespace afm
