// What is restored from a saved state goes on as the run did, to the last bit, wherever the run was; two ways to the
// same point save the same words; what no run can have saved is refused, or ends.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <vector>

#include "afm/emulator.h"
#include "support/recorded_run.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

EmulatorSettings settings_for(double eta, double v_c, ModelKind kind) {
  EmulatorSettings s;
  s.model.v_c = v_c;
  s.model.kind = kind;
  s.eta = eta;
  s.initial.u = eta;
  s.samples_per_batch = 100;
  s.friction_window = 40.0;
  s.impact_budget = 500;
  return s;
}

// What is done to an emulator between two batches, drawn once and done to several.
struct Deed {
  enum Kind { nothing, drag, change, level } kind = nothing;
  double eta = 0.0;
  LiveSettings live{};
  Level to;
};

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double within(double low, double high) { return random_.within(low, high); }
  bool one_in(double n) { return within(0.0, n) < 1.0; }

  Deed deed(const Emulator& at) {
    Deed deed;
    if (one_in(8.0)) {
      deed.kind = Deed::drag;
      deed.eta = kEtas[static_cast<std::size_t>(within(0.0, 8.999))];
    } else if (one_in(25.0)) {
      deed.kind = Deed::change;
      deed.live = live_settings(at.settings());
      if (one_in(2.0)) deed.live.gamma = within(0.3, 0.9);
      if (one_in(3.0)) deed.live.y0 = within(-0.1, 0.05);
      if (one_in(3.0)) deed.live.sample_period = within(0.02, 0.04);
      if (one_in(3.0)) deed.live.friction_window = within(20.0, 60.0);
      if (one_in(2.0)) {
        deed.live.bath.temperature = within(0.0, 1.0);
        deed.live.bath.quality_factor = one_in(4.0) ? 0.0 : within(10.0, 200.0);
        deed.live.bath.kicks_per_tau = within(1.0, 5.0);
      }
    } else if (one_in(25.0)) {
      deed.kind = Deed::level;
      deed.to.kind = one_in(2.0) ? ModelKind::hammer : ModelKind::oscillator;
      deed.to.contact_tolerance = one_in(10.0) ? 0.0 : one_in(3.0) ? 1e-5 : 1e-3;
    }
    return deed;
  }

 private:
  static constexpr double kEtas[] = {0.0, 0.2, 1.0, 2.0, 3.0, -3.4, 5.0, 7.0, 3.4};
  RandomLaunches random_;
};

void obey(const Deed& deed, Emulator& emulator) {
  if (deed.kind == Deed::drag) emulator.drag(deed.eta);
  if (deed.kind == Deed::change) emulator.change(deed.live);
  if (deed.kind == Deed::level) emulator.set_level(deed.to);
}

bool same_bits(const FrictionEstimate& a, const FrictionEstimate& b) {
  static_assert(sizeof a % 8 == 0);  // doubles and a number, without padding
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_same(const Batch& a, const Batch& b) {
  ASSERT_TRUE(a.begin == b.begin && a.end == b.end && a.first_sample_time == b.first_sample_time);
  ASSERT_EQ(a.first_sample, b.first_sample);
  ASSERT_EQ(a.first_impact, b.first_impact);
  ASSERT_EQ(a.eta, b.eta);
  ASSERT_EQ(a.vertical, b.vertical);
  ASSERT_EQ(a.lateral, b.lateral);
  ASSERT_EQ(a.impacts.size(), b.impacts.size());
  for (std::size_t i = 0; i < a.impacts.size(); ++i) ASSERT_TRUE(afm::same_bits(a.impacts[i], b.impacts[i]));
  ASSERT_TRUE(same_bits(a.friction, b.friction));
}

std::vector<std::uint64_t> words_of(const Emulator& emulator) {
  SavedState state;
  emulator.save(state);
  return {state.begin(), state.end()};
}

Emulator copy_by_words(const Emulator& emulator) {
  SavedState state;
  emulator.save(state);
  const auto restored = Emulator::restored(state);
  EXPECT_TRUE(restored.has_value());
  EXPECT_EQ(words_of(*restored), words_of(emulator));
  return restored.value_or(emulator);
}

// A little further: to an impact, to somewhere in a batch, or to its end.
void run_on(Chance& chance, Emulator& emulator, Batch& batch) {
  if (chance.one_in(3.0)) {
    emulator.run_impacts(1 + static_cast<std::uint64_t>(chance.within(0.0, 5.0)), batch);
  } else if (chance.one_in(2.0)) {
    emulator.run_until(emulator.now() + chance.within(0.0, 1.0), batch);
  } else {
    emulator.run_batch(batch);
  }
}

// To where the next event is of this kind, if it is not far: only a tip that is bursting has a burst before it.
void seek(ImpactKind kind, Emulator& emulator, Batch& batch) {
  for (int i = 0; i < 200; ++i) {
    Emulator ahead = emulator;
    for (int batches = 0; batches < 10 && ahead.run_impacts(1, batch) == Outcome::time_limit; ++batches) {
    }
    if (batch.impacts.empty() || batch.impacts.front().kind == kind) return;  // it slides on and on, or is there
    emulator.run_impacts(1, batch);
  }
}

struct Run {
  double eta, v_c;
  ModelKind kind;
};
class SavedStates : public testing::TestWithParam<Run> {
 protected:
  EmulatorSettings settings() const { return settings_for(GetParam().eta, GetParam().v_c, GetParam().kind); }
};

TEST_P(SavedStates, GoOnToTheSameBits) {
  Chance chance(11);
  Emulator emulator(settings());
  Batch batch, again;
  double followed = 0.0;
  std::map<ImpactKind, int> next;  // after a state was saved; it tells what the tip was doing
  for (int states = 0; states < 800; ++states) {
    for (int i = 0; i < 5; ++i) {
      obey(chance.deed(emulator), emulator);
      run_on(chance, emulator, batch);
    }
    if (emulator.eta() != 0.0) seek(static_cast<ImpactKind>(states % 4), emulator, batch);
    if (chance.one_in(2.0)) run_on(chance, emulator, batch);
    if (chance.one_in(3.0)) obey(chance.deed(emulator), emulator);
    Emulator copy = copy_by_words(emulator);
    const ModelTime begin = emulator.now();
    bool reported = false;
    for (int i = 0; i < 6; ++i) {
      emulator.run_batch(batch);
      copy.run_batch(again);
      ASSERT_NO_FATAL_FAILURE(expect_same(batch, again)) << states;
      if (!reported && !batch.impacts.empty()) ++next[batch.impacts.front().kind];
      reported = reported || !batch.impacts.empty();
      const Deed deed = chance.deed(emulator);
      obey(deed, emulator);
      obey(deed, copy);
    }
    followed += emulator.now() - begin;
    ASSERT_EQ(words_of(copy), words_of(emulator)) << states;
  }
  EXPECT_GT(followed, 10000.0);
  EXPECT_GT(next[ImpactKind::impact], 20);
  if (GetParam().v_c < 0.05) {  // it was bursting, and in contact
    EXPECT_GT(next[ImpactKind::burst], 5);
    EXPECT_GT(next[ImpactKind::contact_begun], 5);
    EXPECT_GT(next[ImpactKind::contact_ended], 5);
  }
}

// One takes samples and goes batch by batch, the other does not and stops anywhere: the state is of the run alone.
TEST_P(SavedStates, AreThoseOfTheRunAlone) {
  Chance chance(13);
  Emulator whole(settings()), pieces(settings());
  pieces.take_samples(false);
  Batch batch, piece;
  for (int i = 0; i < 2000; ++i) {
    whole.run_batch(batch);
    whole.run_until(whole.now(), batch);  // where the budget ran out more may happen at the same time
    while (pieces.now() < whole.now() && pieces.impacts() < whole.impacts() && chance.one_in(1.5)) {
      if (chance.one_in(2.0)) {
        pieces.run_impacts(1, piece);
      } else {
        pieces.run_until(pieces.now() + chance.within(0.0, 1.0) * (whole.now() - pieces.now()), piece);
      }
    }
    while (pieces.run_until(whole.now(), piece) == Outcome::budget_spent) continue;
    ASSERT_EQ(words_of(whole), words_of(pieces)) << i;
    const Deed deed = chance.deed(whole);
    obey(deed, whole);
    obey(deed, pieces);
    ASSERT_EQ(words_of(whole), words_of(pieces)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, SavedStates,
                         testing::Values(Run{3.4, 0.05, ModelKind::oscillator}, Run{5.0, 0.01, ModelKind::oscillator},
                                         Run{0.5, 0.005, ModelKind::oscillator}, Run{3.0, 0.02, ModelKind::hammer}));

SavedState state_at(double tau) {
  Emulator emulator(settings_for(5.0, 0.01, ModelKind::oscillator));
  Batch batch;
  while (emulator.now() < ModelTime{} + tau) emulator.run_batch(batch);
  SavedState state;
  emulator.save(state);
  return state;
}

// A stop at an impact leaves the search for the next to whoever goes on, a stop at its time does not.
TEST(SavedState, IsTheSameWhetherOrNotTheNextImpactIsKnown) {
  for (const double eta : {0.5, 2.5, 3.4, 5.0}) {
    Emulator at_impact(settings_for(eta, 0.1, ModelKind::oscillator)), at_time = at_impact;
    Batch batch;
    at_impact.run_impacts(1, batch);
    at_time.run_until(at_impact.now(), batch);
    EXPECT_EQ(words_of(at_impact), words_of(at_time)) << eta;
  }
}

TEST(SavedState, IsRefusedWhereItIsCutOrTooLong) {
  const SavedState state = state_at(100.0);
  ASSERT_TRUE(Emulator::restored(state).has_value());
  for (std::size_t size = 0; size <= SavedState::kMaxWords; ++size) {
    SavedState other = state;
    other.size = size;
    EXPECT_EQ(Emulator::restored(other).has_value(), size == state.size) << size;
  }
  SavedState beyond = state;
  beyond.size = SavedState::kMaxWords + 1;
  EXPECT_FALSE(Emulator::restored(beyond).has_value());
}

// Some are refused; whatever is not must still come to an end of its batches.
TEST(SavedState, AlteredEndsAllTheSame) {
  const SavedState state = state_at(100.0);
  const std::uint64_t words[] = {1, 0x7ff8000000000000, 0x4000000000000000, 0xc340000000000000};
  int refused = 0;
  Batch batch;
  for (std::size_t i = 0; i < state.size; ++i) {
    for (const std::uint64_t word : words) {
      SavedState altered = state;
      altered.words[i] = word;
      auto emulator = Emulator::restored(altered);
      refused += emulator ? 0 : 1;
      if (emulator) emulator->run_batch(batch);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(SavedState, ATipByItselfGoesOnWithTheSameBits) {
  for (const double eta : {0.5, 3.4}) {  // contact and chatter; chaos
    Tip tip(Model{}, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0}, 1e-4);
    Bath warm;
    warm.temperature = 0.9;
    warm.quality_factor = 50.0;
    SavedState state, again;
    tip.save(state);
    for (int i = 0; i < 200; ++i) {
      auto restored = Tip::restored(state);
      ASSERT_TRUE(restored);
      if (i == 100) {
        tip.set_bath(warm);
        restored->set_bath(warm);
      }
      const ModelTime later = tip.now() + 3.7;
      while (tip.advance(later) != Outcome::time_limit) {
      }
      while (restored->advance(later) != Outcome::time_limit) {
      }
      tip.save(state);
      restored->save(again);
      ASSERT_EQ(std::vector<std::uint64_t>(state.begin(), state.end()),
                std::vector<std::uint64_t>(again.begin(), again.end()))
          << "eta " << eta << ", step " << i;
    }
    state.words[0] = 0x7ff8000000000000;  // its temperature is not a number
    EXPECT_FALSE(Tip::restored(state));
    state.size -= 1;
    EXPECT_FALSE(Tip::restored(state));
  }
}

// What the compiler knows of memory before an object is in it, it may leave out: so we make it forget.
void* forget(void* memory) {
  asm volatile("" : "+r"(memory) : : "memory");
  return memory;
}

// An object that is saved as it stands in memory has no padding, or other bytes would come out each time.
template <class T, class... Arguments>
void expect_without_padding(const Arguments&... arguments) {
  alignas(T) unsigned char low[sizeof(T)], high[sizeof(T)];
  std::memset(low, 0, sizeof low);
  std::memset(high, 0xff, sizeof high);
  new (forget(low)) T{arguments...};
  new (forget(high)) T{arguments...};
  forget(low);
  forget(high);
  EXPECT_EQ(std::memcmp(low, high, sizeof low), 0) << typeid(T).name();
}

TEST(SavedState, IsMadeOfObjectsWithoutPadding) {
  const Mechanics<double> mechanics{Model()};
  expect_without_padding<Flight<double>>(mechanics, 3.4, TipState{0.1, 0.0, 3.4, 0.0, 1.0});
  expect_without_padding<SlideSegment<double>>(mechanics, 3.4, SlideState<double>{0.1, 0.0, 3.4});
  expect_without_padding<Friction>(100.0);
  expect_without_padding<SampleGrid>();
  expect_without_padding<ModelTime>();
  expect_without_padding<FreeState>();
  expect_without_padding<Chatter>();
}

}  // namespace
}  // namespace afm
