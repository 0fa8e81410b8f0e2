// The energy balance through bursts, contact and release, at the default tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "trials/energy_balance.h"

namespace afm {
namespace {

constexpr ModelTime kNever{std::int64_t{1} << 60, 0.0};

struct Drag {
  double eta, cutoff_share;
};

void PrintTo(const Drag& drag, std::ostream* out) {
  *out << "eta " << drag.eta << ", v_c " << drag.cutoff_share << " eta";
}

Model mica(const Drag& drag) {
  Model model;
  model.v_c = drag.cutoff_share * std::abs(drag.eta);
  return model;
}

class ContactEnergy : public testing::TestWithParam<Drag> {};

TEST_P(ContactEnergy, WhatIsLostIsTheWorkOfTheDragLessWhatIsStored) {
  const Model model = mica(GetParam());
  Tip tip(model, GetParam().eta, FreeState{0.25, 0.0, 0.2, GetParam().eta, 0.0});
  EnergyBalance balance(tip);
  int events = 0, bursts = 0;
  while (events < 100000) {
    const Outcome outcome = balance.advance_segment(tip, kNever);
    ASSERT_NE(outcome, Outcome::search_failed);
    if (outcome == Outcome::flying) continue;
    ++events;
    if (tip.last_impact().kind == ImpactKind::burst) ++bursts;
    if (events % 1000 != 0) continue;
    ASSERT_LT(balance.imbalance(tip), 1e-12 * balance.turnover(tip)) << events;
  }
  EXPECT_GT(bursts, 20);
  EXPECT_GT(balance.lost(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, ContactEnergy,
                         testing::Values(Drag{0.05, 0.1}, Drag{0.2, 0.1}, Drag{0.2, 0.01}, Drag{0.5, 0.01},
                                         Drag{-0.5, 0.01}, Drag{2.75, 0.01}, Drag{3.0, 0.01}, Drag{5.0, 0.01},
                                         Drag{9.0, 0.01}, Drag{50.0, 0.01}));

TEST(ContactEnergyOfModels, IsInBalanceWhateverTheRestitution) {
  for (const double gamma : {0.0, 0.3, 0.9, 0.99, 1.0}) {
    for (const double v_c : {0.0, 1e-3, 0.05, 10.0}) {
      Model model;
      model.gamma = gamma;
      model.v_c = v_c;
      Tip tip(model, 0.7, FreeState{0.25, 0.0, 0.2, 0.7, 0.0});
      EnergyBalance balance(tip);
      while (tip.now() < ModelTime{300, 0.0}) balance.advance_segment(tip, {300, 0.0});
      EXPECT_LT(balance.imbalance(tip), 1e-12 * balance.turnover(tip)) << gamma << ", v_c " << v_c;
    }
  }
}

}  // namespace
}  // namespace afm
