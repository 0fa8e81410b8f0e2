// Lyapunov exponents: the rates of growth of small displacements along an orbit [1/tau] (the paper expects chaos in
// section VII). There are four, those of the map from impact to impact. The displacement along the orbit neither grows
// nor shrinks and is left out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

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
  budget_spent,   // most_events came first: measured up to there
  no_event,       // too few impacts or slides to measure: a tip at rest
  search_failed,  // an impact search failed: measured up to there
  no_number       // an exponent is NaN, because a Jacobian on the way was NaN
};

// Largest first [1/tau]. In contact two directions collapse, so after a contact the last two exponents are minus
// infinity. The hammer has two exponents, and none after contact; the others are minus infinity. std_errors come from
// batch means. On a chaotic orbit they are the scatter; on a regular one the error falls like 1/duration, and they
// bound nothing. All are NaN where nothing was measured, or the tip lands without any normal speed, as no derivative
// exists there; std_errors where the measurement ended early.
struct LyapunovSpectrum {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  LyapunovOutcome outcome = LyapunovOutcome::no_event;
  int rank = 0;  // exponents that are finite
  std::array<double, 4> exponents{kNaN, kNaN, kNaN, kNaN};
  std::array<double, 4> std_errors{kNaN, kNaN, kNaN, kNaN};
  // The sum of the exponents, of a hammer of its two, from the restitution alone: an impact shrinks the volume by
  // gamma_eff times the slope of the law, a flight keeps it. NaN after a chatter sequence; minus infinity after
  // contact.
  double volume_rate = kNaN;
  double duration = 0.0;  // measured [tau]
  std::uint64_t events = 0;
};

// Along the orbit of `tip`, which is advanced. Benettin's method with the exact Jacobians of jacobian.h.
LyapunovSpectrum lyapunov(const Model& model, Tip& tip, const LyapunovSettings& settings = {});
LyapunovSpectrum lyapunov(const Model& model, double eta, const FreeState& start,
                          const LyapunovSettings& settings = {});
LyapunovSpectrum lyapunov(const Model& model, double eta, const TipState& start, const LyapunovSettings& settings = {});

}  // namespace afm
