// What kind of attractor an orbit ends on.
#pragma once

#include <cstdint>
#include <string>

#include "afm/model.h"
#include "afm/tip.h"
#include "lyapunov.h"

namespace afm {

enum class AttractorKind : std::uint8_t {
  periodic,
  quasi_periodic,
  chaotic,
  contact,    // the tip slides, glides or creeps on the surface for more than half of the time
  rest,       // there is no drag: the tip loses what it has, and ends in a motion that loses nothing
  undecided,  // the budget ran out, or the search for impacts gave up
  thermal     // kicked by a bath: a distribution, not an orbit
};

struct AttractorSettings {
  double transient = 500.0;  // before anything is looked at [tau]
  double duration = 500.0;   // of the measurement of exponents, where the orbit does not repeat itself [tau]
  int longest = 128;         // longest period looked for [impacts]
  double tolerance = 1e-9;   // the orbit repeats itself when it comes back this close [a, a/tau]
  std::uint64_t most_events = 2000000;
};

struct Attractor {
  AttractorKind kind = AttractorKind::undecided;
  // Of a period, where the orbit repeats itself exactly (0 where it does not): impacts (chatter that dies counts as
  // one), and cells that the holder passes: the period is cells / |eta| tau.
  int impacts = 0;
  int cells = 0;
  double contact_share = 0.0;     // of the time: in contact, in bursts, or in bounces below 0.01 a/tau
  double cells_per_impact = 0.0;  // 0 where there are no impacts
  double rotation_number =
      0.0;  // of a quasi-periodic one: turns about the middle of its section by an impact, in [0, 1/2]
  LyapunovSpectrum lyapunov;  // of a periodic orbit: logarithms of its multipliers over its period

  // period-N, quasi-periodic, chaotic, contact, rest, undecided, thermal
  std::string name() const;
};

// Follows the tip until the kind is known; leaves it on the attractor. Never throws, never runs longer than its budget.
Attractor find_attractor(const Model& model, Tip& tip, const AttractorSettings& settings = {});
Attractor find_attractor(const Model& model, double eta, const TipState& start, const AttractorSettings& settings = {});

}  // namespace afm
