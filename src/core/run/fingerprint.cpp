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
  const FrictionEstimate& f = batch.friction;
  for (const double x : {f.K_f_std_error, f.K_f_work, f.K_f_work_std_error, f.heat_to_bath}) digest.add(x);
  digest.add(static_cast<double>(f.impact_count));
}

struct Scene {
  double eta, rest_height = 0.0, temperature = 0.0, quality_factor = 0.0;
  ModelKind kind = ModelKind::oscillator;
};

void add_run(const Scene& scene, Digest& digest) {
  constexpr int kBatches = 4;
  RunSettings settings;
  settings.eta = scene.eta;
  settings.model.y0 = scene.rest_height;
  settings.model.kind = scene.kind;
  settings.bath.temperature = scene.temperature;
  settings.bath.quality_factor = scene.quality_factor;
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
  // slides, the third chatters, the fourth is fast; then a bath, a bath under a load, and a hammer
  constexpr double kRoom = 0.926;  // [m_tip a^2/tau^2] kT on mica
  const Scene scenes[] = {Scene{3.4},
                          Scene{1.0},
                          Scene{5.0},
                          Scene{30.0},
                          Scene{2.0, 0.0, kRoom, 100.0},
                          Scene{2.0, -0.3, kRoom, 100.0},
                          Scene{5.0, 0.0, kRoom, 20.0, ModelKind::hammer}};
  for (const Scene& scene : scenes) add_run(scene, digest);
  return to_text(digest);
}

}  // namespace afm
