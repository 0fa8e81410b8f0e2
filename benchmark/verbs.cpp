// What each verb of the core costs. Every measurement goes over the same saved states again and again.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "afm/ensemble.h"
#include "afm/landing.h"
#include "afm/reflection.h"
#include "afm/run.h"
#include "afm/tip.h"
#include "core/contact/slide_release.h"

namespace {

using namespace afm;

constexpr int kStates = 1000;

// Launches and landings of consecutive impacts after a transient.
struct Chain {
  explicit Chain(double eta_per_cell) : eta(eta_per_cell), springs(model) {
    model.v_c = 0.1 * eta;
    Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0}, 0.0);
    while (tip.now().tau < 300) tip.advance({300, 0.0});
    while (tip.advance(kEndOfTime) != Outcome::impact) continue;
    for (int i = 0; i < kStates; ++i) {
      flights.emplace_back(springs, eta, tip.tip_state());
      const Landing<double> landing = find_landing(model, flights.back(), 8.0);
      times.push_back(0.9 * landing.s);
      incidents.push_back(landing.jet);
      while (tip.advance(kEndOfTime) != Outcome::impact) continue;
    }
  }

  double eta;
  Model model;
  SpringConstants<double> springs;
  std::vector<Flight<double>> flights;
  std::vector<double> times;
  std::vector<GapJet<double>> incidents;
};

double eta_of(const benchmark::State& state) { return 1e-2 * static_cast<double>(state.range(0)); }

// One after the other: each angle waits for the sine before.
void TurnSine(benchmark::State& state) {
  double x = 0.1;
  for (auto _ : state) x = 0.3 + 0.1 * detail::sin_cos_turns(x).sin;
  benchmark::DoNotOptimize(x);
}
BENCHMARK(TurnSine);

template <class Verb>
void over(benchmark::State& state, const Chain& chain, const Verb& verb) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(verb(i));
    i = i + 1 == chain.flights.size() ? 0 : i + 1;
  }
}

void Gap(benchmark::State& state) {
  const Chain chain(eta_of(state));
  over(state, chain, [&](std::size_t i) { return chain.flights[i].gap(chain.times[i]).g; });
}
BENCHMARK(Gap)->Arg(340);

void Search(benchmark::State& state) {
  Chain chain(eta_of(state));  // a flight that may be bounded need not be copied for it
  over(state, chain, [&](std::size_t i) { return find_landing(chain.model, chain.flights[i], 8.0).s; });
}
BENCHMARK(Search)->Arg(50)->Arg(150)->Arg(200)->Arg(250)->Arg(340)->Arg(450)->Arg(600)->Arg(800);

void Reflect(benchmark::State& state) {
  const Chain chain(eta_of(state));
  over(state, chain, [&](std::size_t i) { return reflect(chain.model, chain.eta, chain.incidents[i]).after.u; });
}
BENCHMARK(Reflect)->Arg(340);

// From impact to impact: bounce, launch and search, each waiting for the last.
void Bounce(benchmark::State& state) {
  Model model;
  model.v_c = 0.1 * eta_of(state);
  Tip saved(model, eta_of(state), FreeState{0.25, 0.0, 0.2, eta_of(state), 0.0}, 0.0);
  while (saved.now().tau < 300) saved.advance({300, 0.0});
  Tip tip = saved;
  int impacts = 0;
  for (auto _ : state) {
    while (tip.advance(kEndOfTime) != Outcome::impact) continue;
    if (++impacts % kStates == 0) tip = saved;
  }
}
BENCHMARK(Bounce)->Arg(50)->Arg(150)->Arg(200)->Arg(250)->Arg(340)->Arg(450)->Arg(600)->Arg(800);

// Bounces of a speed that falls from 0.01 a/tau, one by one.
void MicroBounce(benchmark::State& state) {
  const Tip saved(Model{}, 3.0, TipState{0.5, 0.0, 3.0, 0.0, 0.01}, 0.0);
  Tip tip = saved;
  int impacts = 0;
  for (auto _ : state) {
    tip.advance(kEndOfTime);
    if (++impacts % 300 == 0) tip = saved;
  }
}
BENCHMARK(MicroBounce);

// The series of one segment of a slide, and where it ends.
void Slide(benchmark::State& state) {
  const SpringConstants<double> springs{Model{}};
  double phase = 0.4;
  detail::SlideSegment<double> slide(springs, 3.0, {phase, 0.001, 3.0});
  for (auto _ : state) {
    slide = detail::SlideSegment<double>(springs, 3.0, {phase, 0.001, 3.0});
    benchmark::DoNotOptimize(find_release(slide));
    phase = phase > 0.6 ? 0.4 : phase + 1e-3;
  }
}
BENCHMARK(Slide);

// A tau of a tip at its default tolerance, bursts and contact with it.
void OneTau(benchmark::State& state) {
  const double eta = eta_of(state);
  Tip saved(Model{}, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0});
  while (saved.now().tau < 300) saved.advance({300, 0.0});
  Tip tip = saved;
  std::int64_t tau = 300;
  for (auto _ : state) {
    ++tau;
    while (tip.advance({tau, 0.0}) != Outcome::time_limit) continue;
    if (tau < 1300) continue;
    tip = saved;
    tau = 300;
  }
}
BENCHMARK(OneTau)->Arg(0)->Arg(20)->Arg(50)->Arg(100)->Arg(200)->Arg(300)->Arg(340)->Arg(500)->Arg(625)->Arg(700);

void Sample(benchmark::State& state) {
  Tip tip(Model{}, 3.4, FreeState{0.25, 0.0, 0.2, 3.4, 0.0});
  while (tip.now().tau < 300) tip.advance({300, 0.0});
  const double length = tip.segment_end() - tip.now();
  int i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tip.deflection(tip.now() + 1e-3 * i * length));
    i = i == 999 ? 0 : i + 1;
  }
}
BENCHMARK(Sample);

// The same by rows of so many, a sample of one.
void SampleRow(benchmark::State& state) {
  Tip tip(Model{}, 3.4, FreeState{0.25, 0.0, 0.2, 3.4, 0.0});
  while (tip.now().tau < 300) tip.advance({300, 0.0});
  const std::size_t n = static_cast<std::size_t>(state.range(0));
  std::vector<double> vertical(n), lateral(n);
  const SampleGrid grid{(tip.segment_end() - tip.now()) / static_cast<double>(n), 0, tip.now()};
  for (auto _ : state) benchmark::DoNotOptimize(tip.deflections(grid, 0, n, vertical.data(), lateral.data()));
  state.counters["per_sample"] = benchmark::Counter(
      static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SampleRow)->Arg(1)->Arg(4)->Arg(8)->Arg(20)->Arg(46)->Arg(92);

// A batch of 2000 samples at 2.5 MHz, by eta.
void SampledBatch(benchmark::State& state) {
  RunSettings settings;
  settings.eta = settings.initial.u = eta_of(state);
  settings.sample_period = 0.2 / 5.0 / kTwoPi / 2.5;
  Run run(settings);
  Batch batch;
  for (auto _ : state) benchmark::DoNotOptimize(run.advance(batch));
  state.counters["per_sample"] =
      benchmark::Counter(2000.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SampledBatch)->Arg(100)->Arg(340)->Arg(450);

// A snapshot between two batches.
void Split(benchmark::State& state) {
  RunSettings settings;
  settings.eta = settings.initial.u = eta_of(state);
  Run run(settings);
  Batch batch;
  for (int i = 0; i < 10; ++i) run.advance(batch);
  for (auto _ : state) benchmark::DoNotOptimize(run.split());
}
BENCHMARK(Split)->Arg(340);

}  // namespace

BENCHMARK_MAIN();
