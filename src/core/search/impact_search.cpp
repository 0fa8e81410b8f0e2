#include "afm/impact_search.h"

#include <algorithm>
#include <cmath>

#include "afm/detail/double_double.h"
#include "afm/detail/multiversion.h"

namespace afm {
namespace {

constexpr double kFarEnough = 0.1;  // certified so far, a flight of too many looks is begun anew from there [tau]
constexpr double kTouch = 1e-20;    // no gap at all, where rounding hides it in twice the digits [a]

AFM_MULTIVERSION Landing<double> find_in_double(const Flight<double>& flight, double horizon) {
  return find_impact(flight, horizon);
}

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<DoubleDouble>& j = landing.jet;
  const GapJet<double> jet{d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)},
                           d(j.h), d(j.h1)};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

SearchOutcome without_end(const Landing<double>& landing) {
  if (!(landing.jet.g > kTouch)) return SearchOutcome::impact;
  return landing.s >= kFarEnough ? SearchOutcome::clear : SearchOutcome::cap;
}

}  // namespace

Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon) {
  Landing<double> landing = find_in_double(flight, horizon);
  if (landing.outcome == SearchOutcome::undecided) {
    const Flight<DoubleDouble> finer(Mechanics<DoubleDouble>(model), DoubleDouble(flight.eta()), flight.launch());
    landing = rounded(find_impact(finer, DoubleDouble(horizon), DoubleDouble(landing.s)));
  }
  if (landing.outcome == SearchOutcome::undecided || landing.outcome == SearchOutcome::cap)
    landing.outcome = without_end(landing);
  return landing;
}

}  // namespace afm
