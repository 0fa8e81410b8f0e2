// Apart from landing.cpp: beside this second instance of the search the compiler inlines less of the first one, and an
// impact takes longer.
#include "finer_landing.h"

#include "double_double.h"
#include "impact_search.h"

namespace afm::detail {
namespace {

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<DoubleDouble>& j = landing.jet;
  const GapJet<double> jet{d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)},
                           d(j.h), d(j.h1)};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

}  // namespace

Landing<double> find_finer_landing(const Model& model, const Flight<double>& flight, double horizon, double from) {
  const Flight<DoubleDouble> finer(SpringConstants<DoubleDouble>(model), DoubleDouble(flight.eta()), flight.launch());
  return rounded(find_impact(finer, DoubleDouble(horizon), DoubleDouble(from)));
}

}  // namespace afm::detail
