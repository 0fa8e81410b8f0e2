// Lyapunov exponents: how fast small displacements grow along an orbit, per tau. Four of them, of the map from impact
// to impact: a displacement along the orbit itself neither grows nor shrinks and is left out.
#pragma once

#include <array>
#include <cstdint>

#include "afm/model.h"
#include "afm/state.h"
#include "afm/tip.h"

namespace afm {

struct LyapunovSettings {
  double transient = 500.0;              // before the measurement [tau]
  double duration = 2000.0;              // of it [tau]
  std::uint64_t most_events = 20000000;  // impacts, bursts, contacts and releases allowed to both together
  double contact_tolerance = kDefaultContactTolerance;
};

enum class LyapunovOutcome : std::uint8_t {
  measured,
  budget_spent,  // most_events came first: measured up to there
  no_event,      // too few impacts or slides to measure anything: a tip at rest
  search_failed,  // the impact search failed on the way; what is reported is up to there
  no_number       // an exponent is no number, as a Jacobian on the way was none
};

// Largest first [1/tau]. In contact two directions normal to the surface collapse: once the orbit has slid, the last
// two exponents are minus infinity. The hammer has two exponents, and after contact none: the others are minus
// infinity. std_error is that of batch means: the numbers' scatter on a chaotic orbit; on a regular one the exponents
// come to their limit like 1/duration and it bounds nothing.
struct LyapunovSpectrum {
  LyapunovOutcome outcome = LyapunovOutcome::no_event;
  int rank = 0;  // exponents that are finite
  std::array<double, 4> exponents{};
  std::array<double, 4> std_errors{};
  // What the sum must be, from the restitution alone: every impact shrinks volume by gamma_eff times the slope of the
  // law, flight by nothing. NaN where a burst was taken in one step; minus infinity after contact.
  double volume_rate = 0.0;
  double duration = 0.0;  // measured [tau]
  std::uint64_t events = 0;
};

// Of the orbit that `tip` is on; the tip is moved along it. Benettin's method with the exact Jacobians of jacobian.h.
LyapunovSpectrum lyapunov(const Model& model, Tip& tip, const LyapunovSettings& settings = {});
LyapunovSpectrum lyapunov(const Model& model, double eta, const FreeState& start,
                          const LyapunovSettings& settings = {});
LyapunovSpectrum lyapunov(const Model& model, double eta, const TipState& start, const LyapunovSettings& settings = {});

}  // namespace afm
