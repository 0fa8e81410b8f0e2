// Prints a digest of each of a few reference runs, with commands, steps, bursts and contact: the same lines from every
// compiler and every option, or bits depend on who compiled. No ROS, so that it can be built by one command.
#include <cstdio>

#include "afm_emulator/emulator.h"
#include "node/digest.h"

namespace {

using afm::Batch;
using afm::Emulator;
using afm::EmulatorSettings;
using afm::ModelKind;
using afm::node::Digest;

void add(const Batch& batch, Digest& digest) {
  for (const double sample : batch.vertical) digest.add(sample);
  for (const double sample : batch.lateral) digest.add(sample);
  for (const afm::Impact& impact : batch.impacts) {
    digest.add(static_cast<std::uint64_t>(impact.time.tau));
    digest.add(impact.time.phase);
    digest.add(impact.surface_phase);
    digest.add(impact.normal_speed);
    digest.add(impact.tangential_velocity);
    digest.add(impact.energy_loss);
    digest.add(static_cast<std::uint64_t>(impact.kind));
    digest.add(std::uint64_t{impact.count});
  }
  const afm::FrictionEstimate& f = batch.friction;
  for (const double figure : {f.force, f.force_std_error, f.K_f, f.K_f_std_error, f.energy_loss, f.window_force,
                              f.window_K_f, f.window_K_f_std_error}) {
    digest.add(figure);
  }
}

// Commands and steps on and off the batch boundaries.
void run(Emulator& emulator, double eta, Digest& digest) {
  Batch batch;
  const auto taken = [&] { add(batch, digest); };
  for (int i = 0; i < 40; ++i, taken()) emulator.run_batch(batch);
  emulator.drag(-0.7 * eta);
  for (int i = 0; i < 10; ++i, taken()) emulator.run_batch(batch);
  emulator.run_until(emulator.now() + 1.3, batch);
  taken();
  emulator.drag(eta + 0.1);
  emulator.run_impacts(5, batch);
  taken();
  for (int i = 0; i < 10; ++i, taken()) emulator.run_batch(batch);
  emulator.drag(0.0);
  for (int i = 0; i < 5; ++i, taken()) emulator.run_batch(batch);
}

void print_run(double eta, double cutoff, double contact_tolerance, ModelKind kind = ModelKind::oscillator) {
  EmulatorSettings settings;
  settings.model.kind = kind;
  settings.eta = eta;
  settings.model.v_c = cutoff;
  settings.initial.u = eta;
  settings.samples_per_batch = 1000;
  settings.contact_tolerance = contact_tolerance;
  Emulator emulator(settings);
  Digest digest;
  run(emulator, eta, digest);
  std::printf("%seta %g cutoff %g contact_tolerance %g: %s\n", kind == ModelKind::hammer ? "hammer, " : "", eta, cutoff,
              contact_tolerance, to_text(digest).c_str());
}

}  // namespace

int main() {
  for (const double eta : {0.0, 0.5, 1.0, 2.0, 3.0, 3.4, 5.0, 7.5, 30.0}) print_run(eta, 0.05, 1e-4);
  print_run(3.0, 0.3, 0.0);   // every bounce by itself
  print_run(3.4, 0.0, 1e-3);  // the same restitution at every speed
  for (const double eta : {0.5, 3.4}) print_run(eta, 0.05, 1e-3, ModelKind::hammer);
  return 0;
}
