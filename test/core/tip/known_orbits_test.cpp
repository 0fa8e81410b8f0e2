// Flight, search, reflection and the tip together, against orbits that are known otherwise.
#include <gtest/gtest.h>

#include "afm/tip.h"
#include "support/models.h"

namespace afm {
namespace {

// K_f over `impacts` impacts after a transient. On an orbit of one impact that is a whole number of its periods.
double simulated_K_f(const Model& model, double eta, int transient, int impacts) {
  Tip tip(model, eta, start_at(eta));
  for (int i = 0; i < transient; ++i) tip.advance(kEndOfTime);
  const ModelTime begin = tip.now();
  double energy = 0.0;
  for (int i = 0; i < impacts; ++i) {
    tip.advance(kEndOfTime);
    energy += tip.last_impact().energy_loss;
  }
  return energy / ((tip.now() - begin) * eta * eta);
}

struct Known {
  double eta, K_f;
};

const Known kKnown[] = {
    {2.0, even_K_f(0.7)},
    {4.0, even_K_f(0.7)},
    {6.0, even_K_f(0.7)},
    {8.0, even_K_f(0.7)},
    // the map of one impact iterated in 34 digits (Python's mpmath, on the flight's closed form) until K_f stood still
    {1.5, 0.2507777307734768407203532},
    {2.25, 1.603774408582840476679226},
    {4.5, 0.445730537638223617016902}};

TEST(KnownOrbits, TheSimulatedFrictionIsTheKnownOne) {
  for (const double cutoff_share : {0.05, 0.1}) {
    for (const Known& known : kKnown) {
      const double K_f = simulated_K_f(model_with_cutoff(cutoff_share * known.eta), known.eta, 2000, 500);
      EXPECT_NEAR(K_f, known.K_f, 1e-9 * known.K_f) << "eta " << known.eta << ", v_c " << cutoff_share << " eta";
    }
  }
}

}  // namespace
}  // namespace afm
