// What an impact and a sample cost. Every measurement goes over the same saved states again and again.
#include <benchmark/benchmark.h>

#include <vector>

#include "afm/landing.h"
#include "afm/tip.h"

namespace {

using namespace afm;

constexpr int kImpacts = 1000;

double eta_of(const benchmark::State& state) { return 1e-2 * static_cast<double>(state.range(0)); }

// After a transient, every bounce by itself.
Tip settled_tip(double eta) {
  Model model;
  model.v_c = 0.1 * eta;
  Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0}, 0.0);
  while (tip.now().tau < 300) tip.advance({300, 0.0});
  return tip;
}

void to_impact(Tip& tip) {
  while (tip.advance(kEndOfTime) != Outcome::impact) continue;
}

void Search(benchmark::State& state) {
  Tip tip = settled_tip(eta_of(state));
  const SpringConstants<double> springs(tip.model());
  std::vector<Flight<double>> flights;
  for (int i = 0; i < kImpacts; ++i) {
    to_impact(tip);
    flights.emplace_back(springs, tip.eta(), tip.tip_state());
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(find_landing(tip.model(), flights[i], 8.0).s);
    i = i + 1 == flights.size() ? 0 : i + 1;
  }
}
BENCHMARK(Search)->Arg(50)->Arg(150)->Arg(200)->Arg(250)->Arg(340)->Arg(450)->Arg(600)->Arg(800);

// From impact to impact: bounce, launch and search, each waiting for the last.
void Bounce(benchmark::State& state) {
  const Tip saved = settled_tip(eta_of(state));
  Tip tip = saved;
  int impacts = 0;
  for (auto _ : state) {
    to_impact(tip);
    if (++impacts % kImpacts == 0) tip = saved;
  }
}
BENCHMARK(Bounce)->Arg(50)->Arg(150)->Arg(200)->Arg(250)->Arg(340)->Arg(450)->Arg(600)->Arg(800);

Tip flying_tip() {
  Tip tip(Model{}, 3.4, FreeState{0.25, 0.0, 0.2, 3.4, 0.0});
  while (tip.now().tau < 300) tip.advance({300, 0.0});
  return tip;
}

void Sample(benchmark::State& state) {
  const Tip tip = flying_tip();
  const double length = tip.segment_end() - tip.now();
  int i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tip.deflection(tip.now() + 1e-3 * i * length));
    i = i == 999 ? 0 : i + 1;
  }
}
BENCHMARK(Sample);

// The same by rows of so many.
void SampleRow(benchmark::State& state) {
  const Tip tip = flying_tip();
  const std::size_t n = static_cast<std::size_t>(state.range(0));
  std::vector<double> vertical(n), lateral(n);
  const SampleGrid grid{(tip.segment_end() - tip.now()) / static_cast<double>(n), 0, tip.now()};
  for (auto _ : state) benchmark::DoNotOptimize(tip.deflections(grid, 0, n, vertical.data(), lateral.data()));
}
BENCHMARK(SampleRow)->Arg(1)->Arg(4)->Arg(8)->Arg(20)->Arg(46)->Arg(92);

}  // namespace

BENCHMARK_MAIN();
