// Many tips together give bit for bit what each gives alone: on any number of threads, however the advance is split.
#include "afm/ensemble.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "support/recorded_run.h"

namespace {

using namespace afm;

constexpr int kEvents = 1000;

bool identical(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool identical(const Tip& a, const Tip& b) {
  const TipState p = a.tip_state(), q = b.tip_state();
  return a.now() == b.now() && a.in_contact() == b.in_contact() && same_bits(a.last_impact(), b.last_impact()) &&
         identical(p.phase, q.phase) && identical(p.X, q.X) && identical(p.u, q.u) && identical(p.g, q.g) &&
         identical(p.g1, q.g1);
}

// Every drag velocity, with restitutions, cutoffs, centres and frequencies that differ from tip to tip.
std::vector<Tip> mixed_tips(ModelKind kind, double contact_tolerance) {
  std::vector<double> etas{50.0, -50.0, 1.0, -1.0, 1e-3, 0.0};
  for (int i = 1; i <= 180; ++i) etas.push_back((i % 7 == 0 ? -0.05 : 0.05) * i);
  std::vector<Tip> tips;
  for (std::size_t i = 0; i < etas.size(); ++i) {
    Model model;
    model.kind = kind;
    model.gamma = std::vector<double>{0.7, 0.3, 0.95, 0.5, 1.0, 0.1}[i % 6];
    model.v_c = std::vector<double>{0.05, 0.1, 0.3, 0.0}[i % 4] * (i % 5 == 0 ? std::abs(etas[i]) : 1.0);
    if (i % 11 == 3) model.y0 = -0.05;
    if (i % 13 == 5) model.frequency_ratio = 3.7;
    const double n = static_cast<double>(i);
    tips.emplace_back(model, etas[i], FreeState{0.005 * n, 1e-3 * n / 180.0, 0.15, etas[i], 0.0}, contact_tolerance);
  }
  return tips;
}

struct Runs {
  std::vector<Tip> tips;
  std::vector<Impact> impacts;  // of each, in turn
};

Runs one_by_one(std::vector<Tip> tips, const ModelTime& limit) {
  std::vector<Impact> impacts(tips.size() * kEvents);
  for (std::size_t i = 0; i < tips.size(); ++i) {
    Impact* log = &impacts[i * kEvents];
    for (int k = 0; k < kEvents; ++k) {
      const Outcome outcome = tips[i].advance(limit);
      if (outcome == Outcome::time_limit) break;
      *log++ = tips[i].last_impact();
    }
  }
  return {std::move(tips), std::move(impacts)};
}

Ensemble together(const std::vector<Tip>& tips, int threads) {
  Ensemble ensemble(threads);
  ensemble.reserve(tips.size());
  for (const Tip& tip : tips) ensemble.add(tip);
  return ensemble;
}

void expect_identical(Ensemble& ensemble, const std::vector<Impact>& log, const Runs& runs) {
  ASSERT_EQ(log.size(), runs.impacts.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    ASSERT_TRUE(same_bits(log[i], runs.impacts[i]))
        << "record " << i % kEvents << " of eta " << runs.tips[i / kEvents].eta();
  }
  for (std::size_t i = 0; i < runs.tips.size(); ++i) {
    ASSERT_TRUE(identical(ensemble.tip(i), runs.tips[i])) << "tip " << i << ", eta " << runs.tips[i].eta();
  }
}

// Models and drag velocities mixed.
class EnsembleBits : public testing::TestWithParam<std::tuple<ModelKind, double>> {};

TEST_P(EnsembleBits, EveryImpactIsThatOfOneTip) {
  const auto tips = mixed_tips(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const ModelTime limit{600, 0.0};  // some have few impacts, or rest
  const Runs runs = one_by_one(tips, limit);
  for (const int threads : {1, 3}) {
    Ensemble ensemble = together(tips, threads);
    std::vector<Impact> log(runs.impacts.size());
    ensemble.advance(kEvents, limit, log.data());
    expect_identical(ensemble, log, runs);
  }
}

INSTANTIATE_TEST_SUITE_P(ModelsAndTolerances, EnsembleBits,
                         testing::Combine(testing::Values(ModelKind::oscillator, ModelKind::hammer),
                                          testing::Values(0.0, kDefaultContactTolerance)));

// Steps, times and commands of every kind change nothing that they would not change for one tip.
TEST(Ensemble, SplitsAndCommandsAreThoseOfOneTip) {
  std::vector<Tip> tips = mixed_tips(ModelKind::oscillator, kDefaultContactTolerance);
  Ensemble ensemble = together(tips, 2);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.5);
  ModelTime now;
  for (int step = 0; step < 60; ++step) {
    const ModelTime limit = step % 3 == 2 ? now + 30.0 : (now = now + part(random));
    const int events = step % 3 == 2 ? 1 : step % 2 == 0 ? 1000000 : 2;
    ensemble.advance(static_cast<std::uint32_t>(events), limit);
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (int k = 0; k < events; ++k) {
        if (tips[i].advance(limit) == Outcome::time_limit) break;
      }
    }
    for (std::size_t i = static_cast<std::size_t>(step % 4); i < tips.size(); i += 4) {
      ASSERT_TRUE(identical(ensemble.tip(i), tips[i])) << "step " << step << ", eta " << tips[i].eta();
    }
    for (std::size_t i = static_cast<std::size_t>(step); i < tips.size(); i += 37) {
      const double eta = tips[i].eta() + part(random) - 0.7;
      ensemble.drag(i, eta);
      tips[i].drag(eta);
    }
  }
}

TEST(Ensemble, EachToItsOwnLimit) {
  std::vector<Tip> tips = mixed_tips(ModelKind::oscillator, kDefaultContactTolerance);
  Ensemble ensemble = together(tips, 2);
  std::vector<ModelTime> limits(tips.size());
  for (int round = 1; round <= 3; ++round) {
    for (std::size_t i = 0; i < tips.size(); ++i) limits[i] = limits[i] + 0.37 * static_cast<double>(i % 17);
    ensemble.advance(1000000, limits.data());
    for (std::size_t i = 0; i < tips.size(); ++i) {
      while (tips[i].advance(limits[i]) != Outcome::time_limit) continue;
      ASSERT_TRUE(identical(ensemble.tip(i), tips[i])) << "round " << round << ", eta " << tips[i].eta();
    }
  }
}

TEST(Ensemble, NothingAskedIsNothingDone) {
  Ensemble empty(4);
  empty.advance({10, 0.0});
  Ensemble ensemble(1);
  ensemble.add(Tip(Model{}, 3.4, FreeState{0.25, 0.0, 0.2, 3.4, 0.0}));
  ensemble.advance(0, kEndOfTime);
  EXPECT_EQ(ensemble.tip(0).now(), ModelTime{});
  ensemble.advance({3, 0.25});
  EXPECT_EQ(ensemble.tip(0).now(), (ModelTime{3, 0.25}));
}

}  // namespace
