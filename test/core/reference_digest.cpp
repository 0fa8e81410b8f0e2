// Prints a digest of each of a few reference runs, with commands, steps, bursts and contact, and of many tips together:
// the same lines from every compiler, every option and every machine, whatever lanes it has, or bits depend on who
// compiled. No ROS, so that it can be built by one command.
#include <cstdio>
#include <string>
#include <vector>

#include "afm/ensemble.h"
#include "afm/run.h"
#include "core/run/digest.h"
#include "support/commands.h"

namespace {

using afm::Batch;
using afm::Digest;
using afm::ModelKind;
using afm::Run;
using afm::RunSettings;

void add(const afm::Impact& impact, Digest& digest) {
  digest.add(static_cast<std::uint64_t>(impact.time.tau));
  digest.add(impact.time.phase);
  digest.add(impact.surface_phase);
  digest.add(impact.normal_speed);
  digest.add(impact.tangential_velocity);
  digest.add(impact.energy_loss);
  digest.add(static_cast<std::uint64_t>(impact.kind));
  digest.add(std::uint64_t{impact.count});
}

void add(const Batch& batch, Digest& digest) {
  for (const double sample : batch.vertical) digest.add(sample);
  for (const double sample : batch.lateral) digest.add(sample);
  for (const afm::Impact& impact : batch.impacts) add(impact, digest);
  const afm::FrictionEstimate& f = batch.friction;
  for (const double figure : {f.force, f.force_std_error, f.K_f, f.K_f_std_error, f.energy_loss, f.window_force,
                              f.window_K_f, f.window_K_f_std_error}) {
    digest.add(figure);
  }
}

// Commands and steps on and off the batch boundaries.
void follow(Run& run, double eta, Digest& digest) {
  Batch batch;
  const auto taken = [&] { add(batch, digest); };
  for (int i = 0; i < 40; ++i, taken()) run.advance(batch);
  drag(run, -0.7 * eta);
  for (int i = 0; i < 10; ++i, taken()) run.advance(batch);
  advance_to(run.now() + 1.3, run, batch);
  taken();
  drag(run, eta + 0.1);
  advance_impacts(5, run, batch);
  taken();
  for (int i = 0; i < 10; ++i, taken()) run.advance(batch);
  drag(run, 0.0);
  for (int i = 0; i < 5; ++i, taken()) run.advance(batch);
}

void print_run(const char* name, double eta, RunSettings settings) {
  settings.eta = settings.initial.u = eta;
  settings.samples_per_batch = 1000;
  Run run(settings);
  Digest digest;
  follow(run, eta, digest);
  std::printf("%s: %s\n", name, to_text(digest).c_str());
}

void print_cold(double eta, double cutoff, double contact_tolerance, ModelKind kind = ModelKind::oscillator) {
  char name[100];
  std::snprintf(name, sizeof name, "%seta %g cutoff %g contact_tolerance %g",
                kind == ModelKind::hammer ? "hammer, " : "", eta, cutoff, contact_tolerance);
  RunSettings settings;
  settings.model.kind = kind;
  settings.model.v_c = cutoff;
  settings.contact_tolerance = contact_tolerance;
  print_run(name, eta, settings);
}

void print_bath(double eta, double temperature, double quality_factor, ModelKind kind) {
  char name[100];
  std::snprintf(name, sizeof name, "bath: %s, eta %g temperature %g quality_factor %g", afm::name(kind), eta,
                temperature, quality_factor);
  RunSettings settings;
  settings.model.kind = kind;
  settings.bath.temperature = temperature;
  settings.bath.quality_factor = quality_factor;
  print_run(name, eta, settings);
}

// The records of segments, and the mean lateral force that comes of them.
void print_segments(double eta, double cutoff, ModelKind kind) {
  const std::string name = "segments of the " + std::string(afm::name(kind));
  RunSettings settings;
  settings.model.kind = kind;
  settings.model.v_c = cutoff;
  settings.eta = settings.initial.u = eta;
  Run run(settings);
  afm::Tip tip(settings.model, eta, settings.initial);
  afm::Segments ended;
  Batch batch;
  Digest digest;
  for (int segments = 0; segments < 5000; ++segments) {
    tip.advance_segment(afm::kEndOfTime, &ended);
    for (const afm::Segment& s : ended) {
      for (const double figure : {s.impulse, s.loss, s.stored}) digest.add(figure);
    }
  }
  for (int i = 0; i < 20; ++i) {
    run.advance(batch);
    digest.add(batch.friction.mean_lateral_force);
    digest.add(batch.friction.mean_lateral_force_std_error);
  }
  std::printf("%s: %s\n", name.c_str(), to_text(digest).c_str());
}

// Every impact of tips that are as different as can be, flown together.
void print_together(const std::string& name, int threads, afm::Bath bath = {}) {
  constexpr std::uint32_t kTips = 96, kEvents = 60;
  afm::Ensemble tips(threads);
  for (std::uint32_t i = 0; i < kTips; ++i) {
    afm::Model model;
    model.kind = i % 5 == 4 ? ModelKind::hammer : ModelKind::oscillator;
    model.gamma = i % 3 == 0 ? 0.4 : 0.7;
    model.v_c = i % 2 == 0 ? 0.3 : 0.05;
    const double eta = (i % 7 == 6 ? -0.125 : 0.125) * i, extension = 1e-3 * i;
    afm::Tip tip(model, eta, afm::FreeState{0.25, extension, 0.2, eta, 0.0}, i % 4 == 0 ? 0.0 : 1e-3);
    tip.set_bath(bath);
    bath.stream += 1;
    tips.add(tip);
  }
  std::vector<afm::Impact> log(kTips * kEvents);
  tips.advance(kEvents, {200, 0.0}, log.data());
  Digest digest;
  for (const afm::Impact& impact : log) add(impact, digest);
  std::printf("%s: %s\n", name.c_str(), to_text(digest).c_str());
}

}  // namespace

int main() {
  for (const double eta : {0.0, 0.5, 1.0, 2.0, 3.0, 3.4, 5.0, 7.5, 30.0}) print_cold(eta, 0.05, 1e-4);
  print_cold(3.0, 0.3, 0.0);   // every bounce by itself
  print_cold(3.4, 0.0, 1e-3);  // the same restitution at every speed
  for (const double eta : {0.5, 3.4}) print_cold(eta, 0.05, 1e-3, ModelKind::hammer);
  print_segments(0.5, 0.01, ModelKind::oscillator);  // flights, bursts, contact
  print_segments(-0.3, 0.02, ModelKind::hammer);
  print_together("96 tips one after another", 1);
  print_together("96 tips on three threads", 3);
  print_bath(3.4, 0.926, 100.0, ModelKind::oscillator);
  print_bath(0.3, 1e-3, 20.0, ModelKind::oscillator);  // kicks in chatter and contact
  print_bath(2.0, 0.3, 50.0, ModelKind::hammer);
  afm::Bath bath;
  bath.temperature = 0.1;
  bath.quality_factor = 100.0;
  for (const int threads : {1, 3})
    print_together("96 heated tips on " + std::to_string(threads) + " threads", threads, bath);
  return 0;
}
