#include "afm/landing.h"

#include "core/release_noise.h"
#include "finer_landing.h"
#include "impact_search.h"

namespace afm {
namespace {

using namespace detail;

// After too many evaluations a flight restarts from where it is certified, if that is later than this [tau]. A choice:
// each restart then makes progress.
constexpr double kMinProgress = 0.1;
// [a] No gap is left: a tenth of the rounding of a height of 1 a. A tip that keeps so close glides on the surface
// (eta = 1, the springs at rest). Above this the evaluations reach further than kMinProgress: the gap of a glide has
// only its fourth derivative, below 1e4 a/tau^4, so that each step is at least 1e-5 tau.
constexpr double kNoGap = 1e-17;

SearchOutcome without_end(const Landing<double>& landing) {
  if (!(landing.jet.g > kNoGap)) return SearchOutcome::impact;
  return landing.s >= kMinProgress ? SearchOutcome::clear : SearchOutcome::cap;
}

// Whether rounding of the gap's acceleration may have made it, as where a tip is launched in balance.
bool is_of_rounding(const Flight<double>& flight, const Landing<double>& landing) {
  const GapJet<double>& start = flight.start();
  return landing.outcome == SearchOutcome::impact && landing.s < kEarlyLanding && start.g1 > 0.0 &&
         start.g2 > -release_noise(flight.springs(), flight.eta() + start.state.U, start.state.X);
}

}  // namespace

Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon) {
  Landing<double> landing = find_impact(flight, horizon);
  const bool early = is_of_rounding(flight, landing);
  if (early || landing.outcome == SearchOutcome::undecided) {
    landing = find_finer_landing(model, flight, horizon, early ? 0.0 : landing.s);
  }
  if (landing.outcome == SearchOutcome::undecided || landing.outcome == SearchOutcome::cap)
    landing.outcome = without_end(landing);
  return landing;
}

}  // namespace afm
