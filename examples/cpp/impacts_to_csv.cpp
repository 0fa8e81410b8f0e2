// Every impact of a run, a line each: time, place, speeds before the impact, energy lost. In SI.
#include <afm/afm.h>

#include <cstdio>

int main() {
  const afm::SiModel mica;  // change what you like: mica.restitution_gamma = 0.8
  const afm::Units units(mica);
  const afm::Model model = units.to_natural(mica);
  const double eta = 10e-6 / units.velocity();  // 10 um/s
  afm::Tip tip(model, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0});

  std::printf("time_s,surface_phase,normal_speed_m_per_s,tangential_velocity_m_per_s,energy_loss_j,kind,count\n");
  const afm::ModelTime end = afm::ModelTime{} + 10e-3 / units.time();  // 10 ms
  while (tip.advance(end) != afm::Outcome::time_limit) {
    const afm::Impact& impact = tip.last_impact();
    const double time = (impact.time - afm::ModelTime{}) * units.time();
    std::printf("%.17g,%.17g,%.17g,%.17g,%.17g,%d,%u\n", time, impact.surface_phase,
                impact.normal_speed * units.velocity(), impact.tangential_velocity * units.velocity(),
                impact.energy_loss * units.energy(), static_cast<int>(impact.kind), impact.count);
  }
}
