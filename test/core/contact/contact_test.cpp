// Bursts and contact of a whole tip: the error they bring, and the order of their events.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "trials/burst_trials.h"

namespace afm {
namespace {

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

class BurstsAt : public testing::TestWithParam<Drag> {};

// benchmark/burst_error measures the same over more bursts.
TEST_P(BurstsAt, AreWithinTheToleranceAtTheNextImpact) {
  constexpr std::size_t kBursts = 100;
  for (const double tolerance : {1e-4, kDefaultContactTolerance}) {
    BurstTrials trials(mica(GetParam()), GetParam().eta, tolerance, 1, 5000);
    std::vector<double> errors;
    for (int i = 0; i < 10000 && errors.size() < kBursts; ++i) {  // some have too many bounces
      if (const std::optional<BurstTrial> trial = trials.next()) errors.push_back(trial->worst());
    }
    ASSERT_EQ(errors.size(), kBursts);
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[kBursts / 2], 0.03 * tolerance) << tolerance;
    EXPECT_LT(errors[kBursts * 95 / 100], 0.2 * tolerance) << tolerance;
    EXPECT_LT(errors.back(), tolerance) << tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, BurstsAt,
                         testing::Values(Drag{0.05, 0.0}, Drag{0.05, 0.2}, Drag{0.2, 0.1}, Drag{0.5, 0.1},
                                         Drag{3.0, 0.1}, Drag{5.0, 0.1}, Drag{7.0, 0.1}, Drag{9.0, 0.1},
                                         Drag{0.2, 0.01}, Drag{0.5, 0.01}, Drag{3.0, 0.01}, Drag{5.0, 0.01},
                                         Drag{7.0, 0.01}, Drag{9.0, 0.01}));

// A burst costs as much as five bounces. Here the horizontal spring swings, and the pressure with it.
TEST(Bursts, SeldomReplaceOneBounceOrTwo) {
  Model model;
  model.v_c = 0.05;
  Tip tip(model, 0.35, FreeState{0.3, 0.0, 0.2, 0.35, 0.0});
  int bursts = 0, brief = 0;
  for (Outcome outcome; (outcome = tip.advance({1000, 0.0})) != Outcome::time_limit;) {
    if (outcome != Outcome::impact || tip.last_impact().kind != ImpactKind::burst) continue;
    ++bursts;
    if (tip.last_impact().count <= 2) ++brief;
  }
  EXPECT_GT(bursts, 300);
  EXPECT_LT(brief, bursts / 3);
}

// Who may follow whom: a burst that dies is contact at once, contact ends before anything else happens.
void expect_order(const Impact& before, bool in_contact, const Impact& event) {
  ASSERT_LE(before.time, event.time);
  ASSERT_EQ(in_contact, event.kind == ImpactKind::contact_ended);
  const bool contact = event.kind == ImpactKind::contact_begun || event.kind == ImpactKind::contact_ended;
  ASSERT_EQ(event.count == 0, contact);
  if (!contact) return;
  ASSERT_EQ(event.energy_loss, 0.0);
  ASSERT_EQ(event.normal_speed, 0.0);
  ASSERT_TRUE(event.kind == ImpactKind::contact_ended || before.time == event.time);
}

TEST(ContactEvents, ComeInOrder) {
  for (const Drag& drag :
       {Drag{0.05, 0.1}, Drag{0.2, 0.01}, Drag{0.5, 0.01}, Drag{3.0, 0.01}, Drag{-9.0, 0.001}, Drag{1.0, 0.0}}) {
    Tip tip(mica(drag), drag.eta, FreeState{0.25, 0.0, 0.2, drag.eta, 0.0});
    Impact before;
    bool in_contact = false;
    int contacts = 0;
    for (int i = 0; i < 20000; ++i) {
      const Outcome outcome = tip.advance({20000, 0.0});
      if (outcome == Outcome::time_limit) break;
      const Impact& event = tip.last_impact();
      expect_order(before, in_contact, event);
      ASSERT_EQ(outcome == Outcome::contact, event.kind == ImpactKind::contact_begun);
      ASSERT_EQ(outcome == Outcome::released, event.kind == ImpactKind::contact_ended);
      ASSERT_FALSE(HasFatalFailure()) << "eta " << drag.eta << " event " << i;
      in_contact = outcome == Outcome::contact;
      ASSERT_EQ(tip.in_contact(), in_contact);
      if (in_contact) ++contacts;
      before = event;
    }
    EXPECT_GT(contacts, 0) << drag.eta;
  }
}

}  // namespace
}  // namespace afm
