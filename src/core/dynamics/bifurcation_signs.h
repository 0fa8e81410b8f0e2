// Recognizes bifurcations of a periodic orbit by its multipliers and impacts.
#pragma once

#include "afm/dynamics/continuation.h"

namespace afm {

// An integer that changes at a bifurcation of the kind.
int bifurcation_sign(BifurcationKind kind, const PeriodicOrbit& orbit, double v_c);

// True: the orbit at a change of sign is at a bifurcation of that kind. Multipliers may also jump past the unit circle
// at a corner, or a pair may split on the real axis.
bool confirms(BifurcationKind kind, const PeriodicOrbit& orbit);

// Argument of the pair on the unit circle [turns]; 0 without such a pair.
double turns_on_circle(const PeriodicOrbit& orbit);

}  // namespace afm
