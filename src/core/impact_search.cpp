#include "afm_emulator/impact_search.h"

#include "afm_emulator/double_double.h"
#include "afm_emulator/multiversion.h"

namespace afm {
namespace {

AFM_MULTIVERSION Landing<double> find_in_double(const Flight<double>& flight, double horizon) {
  return find_impact(flight, horizon);
}

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<DoubleDouble>& j = landing.jet;
  const GapJet<double> jet{d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)}, d(j.h),
                           d(j.h1)};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

}  // namespace

Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon) {
  Landing<double> landing = find_in_double(flight, horizon);
  if (landing.outcome == SearchOutcome::undecided) {
    const Mechanics<DoubleDouble> mechanics(model);
    const Flight<DoubleDouble> finer(mechanics, DoubleDouble(flight.eta()), flight.launch());
    landing = rounded(find_impact(finer, DoubleDouble(horizon)));
    if (landing.outcome == SearchOutcome::undecided) landing.outcome = SearchOutcome::impact;
  }
  return landing;
}

}  // namespace afm
