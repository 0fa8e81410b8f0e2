// Evaluations of the gap per impact, over many consecutive impacts at eight drag velocities. changed_constants.py
// compiles it with other constants of the search.
#include <cstdio>

#include "afm/reflection.h"
#include "core/search/impact_search.h"

int main() {
  constexpr int kSkipped = 1000, kImpacts = 20000;
  long evaluations = 0, impacts = 0, undecided = 0;
  for (const double eta : {0.5, 1.5, 2.0, 3.0, 3.4, 4.5, 6.0, 8.0}) {
    afm::Model model;
    model.v_c = 0.1 * eta;
    const afm::SpringConstants<double> springs(model);
    afm::TipState state = to_tip_state(model.H, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0});
    for (int i = -kSkipped; i < kImpacts; ++i) {
      const afm::Flight<double> flight(springs, eta, state);
      const afm::Landing<double> landing = find_landing(model, flight, 1e3);
      if (landing.outcome != afm::SearchOutcome::impact) break;
      const afm::Reflection r = reflect(model, eta, landing.jet);
      state = {r.after.phase, r.after.X, r.after.u, 0.0, r.after.g1};
      if (!(state.g1 > 1e-6))
        state = to_tip_state(model.H, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0});  // no contact here
      if (i < 0) continue;
      ++impacts;
      evaluations += landing.evaluations;
      undecided += afm::detail::find_impact(flight, 1e3).outcome == afm::SearchOutcome::undecided;
    }
  }
  std::printf("%.4f,%ld,%ld\n", static_cast<double>(evaluations) / static_cast<double>(impacts), impacts, undecided);
}
