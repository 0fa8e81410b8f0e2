// Many tips together give bit for bit what each gives alone: on any number of threads, however the advance is split.
#include "afm/ensemble.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "support/models.h"
#include "support/recorded_run.h"

namespace afm {
namespace {

bool identical(const Tip& a, const Tip& b) {
  const TipState p = a.tip_state(), q = b.tip_state();
  return a.now() == b.now() && same_bits(a.last_impact(), b.last_impact()) && std::memcmp(&p, &q, sizeof p) == 0;
}

// Every drag velocity, and both models: some have few impacts, or rest.
std::vector<Tip> mixed_tips() {
  std::vector<Tip> tips;
  for (int i = 0; i <= 180; ++i) {
    const double eta = (i % 7 == 0 ? -0.05 : 0.05) * i;
    const ModelKind kind = i % 3 == 0 ? ModelKind::hammer : ModelKind::oscillator;
    tips.emplace_back(model_with(0.7, 0.05, kind), eta, start_at(eta));
  }
  return tips;
}

Ensemble together(const std::vector<Tip>& tips, int threads) {
  Ensemble ensemble(threads);
  ensemble.reserve(tips.size());
  for (const Tip& tip : tips) ensemble.add(tip);
  return ensemble;
}

TEST(Ensemble, EveryImpactIsThatOfOneTip) {
  constexpr std::uint32_t kEvents = 1000;
  const ModelTime limit{600, 0.0};
  std::vector<Tip> tips = mixed_tips();
  std::vector<Impact> impacts(tips.size() * kEvents);  // of each, in turn
  for (std::size_t i = 0; i < tips.size(); ++i) {
    for (std::size_t k = 0; k < kEvents && tips[i].advance(limit) != Outcome::time_limit; ++k) {
      impacts[i * kEvents + k] = tips[i].last_impact();
    }
  }
  for (const int threads : {1, 3}) {
    Ensemble ensemble = together(mixed_tips(), threads);
    std::vector<Impact> log(impacts.size());
    ensemble.advance(kEvents, limit, log.data());
    for (std::size_t i = 0; i < log.size(); ++i) {
      ASSERT_TRUE(same_bits(log[i], impacts[i])) << "record " << i % kEvents << " of eta " << tips[i / kEvents].eta();
    }
    for (std::size_t i = 0; i < tips.size(); ++i) ASSERT_TRUE(identical(ensemble.tip(i), tips[i])) << tips[i].eta();
  }
}

// A limit for each, steps and commands change nothing that they would not change for one tip.
TEST(Ensemble, SplitsAndCommandsAreThoseOfOneTip) {
  std::vector<Tip> tips = mixed_tips();
  Ensemble ensemble = together(tips, 2);
  std::vector<ModelTime> limits(tips.size());
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.5);
  for (std::uint32_t step = 0; step < 60; ++step) {
    const std::uint32_t events = step % 2 == 0 ? 1000000 : 2;
    for (std::size_t i = 0; i < tips.size(); ++i) limits[i] = tips[i].now() + part(random);
    ensemble.advance(events, limits.data());
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (std::uint32_t k = 0; k < events && tips[i].advance(limits[i]) != Outcome::time_limit; ++k) continue;
      ASSERT_TRUE(identical(ensemble.tip(i), tips[i])) << "step " << step << ", eta " << tips[i].eta();
    }
    for (std::size_t i = step; i < tips.size(); i += 37) {
      const double eta = tips[i].eta() + part(random) - 0.7;
      ensemble.drag(i, eta);
      tips[i].drag(eta);
    }
  }
}

TEST(Ensemble, NothingAskedIsNothingDone) {
  Ensemble empty(4);
  empty.advance({10, 0.0});
  Ensemble ensemble(1);
  ensemble.add(Tip(Model{}, 3.4, start_at(3.4)));
  ensemble.advance(0, kEndOfTime);
  EXPECT_EQ(ensemble.tip(0).now(), ModelTime{});
  ensemble.advance({3, 0.25});
  EXPECT_EQ(ensemble.tip(0).now(), (ModelTime{3, 0.25}));
}

}  // namespace
}  // namespace afm
