// The kind of attractor on which an orbit ends; the paper asks for such a list in section VII. Natural units.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "afm/model.h"
#include "afm/tip.h"
#include "lyapunov.h"

namespace afm {

enum class AttractorKind : std::uint8_t {
  periodic,
  quasi_periodic,
  chaotic,
  contact,   // in contact, in chatter or in bounces below 0.01 a/tau for more than half of the time
  rest,      // no drag, and impacts that take energy: the motion ends without losses
  undecided  // the budget ran out, a search failed, or the exponent is above zero by less than its error
};

struct AttractorSettings {
  double transient = 500.0;       // before the measurement [tau]
  double duration = 500.0;        // of the measurement of exponents, if the orbit is not periodic [tau]
  int longest = 128;              // longest period [impacts]
  double tolerance = 1e-9;        // distance at which a return counts as a period [a, a/tau]
  std::uint64_t most_events = 0;  // the budget; 0: 2000 a tau
};

struct Attractor {
  AttractorKind kind = AttractorKind::undecided;
  // Counts over one period, 0 if the orbit is not periodic. Impacts: chatter that dies counts as one. Cells: lattice
  // cells that the holder passes, so the period is cells / |eta| tau.
  int impacts = 0;
  int cells = 0;
  // part of the time in contact, in chatter or in bounces below 0.01 a/tau; at rest NaN, as nothing is measured
  double contact_share = 0.0;
  double cells_per_impact = 0.0;  // 0 without impacts
  // if quasi-periodic on one closed curve in the section: turns per impact on it, in [0, 1/2]; else NaN
  double rotation_number = std::numeric_limits<double>::quiet_NaN();
  LyapunovSpectrum lyapunov;  // if periodic: logarithms of the multipliers over the period

  // period-N, quasi-periodic, chaotic, contact, rest, undecided
  std::string name() const;
};

// Follows the tip until the kind is known and leaves it on the attractor. Guarantee: no exception. The search makes no
// more events than the budget, nor does any of the at most four measurements of exponents.
Attractor find_attractor(const Model& model, Tip& tip, const AttractorSettings& settings = {});
Attractor find_attractor(const Model& model, double eta, const TipState& start, const AttractorSettings& settings = {});

}  // namespace afm
