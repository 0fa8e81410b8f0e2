#include "afm/fingerprint.h"

#include "afm/run.h"
#include "core/run/digest.h"

namespace afm {
namespace {

void add(const Batch& batch, Digest& digest) {
  for (const double sample : batch.vertical) digest.add(sample);
  for (const double sample : batch.lateral) digest.add(sample);
  for (const Impact& impact : batch.impacts) {
    digest.add(impact.time.phase);
    digest.add(impact.surface_phase);
    digest.add(impact.normal_speed);
    digest.add(impact.tangential_velocity);
    digest.add(impact.energy_loss);
  }
}

void add_run(double eta, Digest& digest) {
  constexpr int kBatches = 4;
  RunSettings settings;
  settings.eta = eta;
  settings.samples_per_batch = 500;
  settings.impact_budget = 1000;
  Run run(settings);
  Batch batch;
  for (int i = 0; i < kBatches; ++i) {
    run.advance(batch);
    add(batch, digest);
  }
}

}  // namespace

std::string arithmetic_fingerprint() {
  Digest digest;
  // chaos makes the last bit of any operation show: it grows tenfold or so in every tau of the first; the second
  // slides, the third chatters
  for (const double eta : {3.4, 1.0, 5.0}) add_run(eta, digest);
  return to_text(digest);
}

}  // namespace afm
