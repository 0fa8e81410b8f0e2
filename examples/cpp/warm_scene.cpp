// A scene of one's own: a stiffer contact under load, at 300 K. Its friction, live, as the node publishes it.
#include <afm/afm.h>

#include <cstdio>

int main() {
  afm::SiModel tip;
  tip.rest_height_m = -0.02e-9;  // the holder below mid-surface: a load
  tip.restitution_gamma = 0.8;
  afm::SiBath bath;
  bath.temperature_k = 300.0;
  bath.quality_factor = 100.0;

  const afm::Units units(tip);
  afm::RunSettings scene;
  scene.model = units.to_natural(tip);
  scene.bath = units.to_natural(bath);
  scene.eta = scene.initial.u = 6.6e-6 / units.velocity();  // 6.6 um/s
  afm::Run run(scene);                                      // throws a ParameterError that names what it cannot run

  afm::Batch batch;  // samples of the deflection, impacts, friction: of 60 tau each
  for (int i = 0; i < 100; ++i) {
    run.advance(batch);
    if (i % 10 == 9) {
      std::printf("%6.0f tau: force %.6g N, K_f %.6g +- %.6g kg/s\n", run.now() - afm::ModelTime{},
                  batch.friction.mean_lateral_force * units.force(), batch.friction.K_f_work * units.friction(),
                  batch.friction.K_f_work_std_error * units.friction());
    }
  }
}
