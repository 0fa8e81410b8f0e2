// The periodic orbit at the friction peak eta = 2: found, judged by its multipliers, and drawn as a table.
#include <afm/afm.h>
#include <afm/dynamics/periodic_orbit.h>

#include <cstdio>

int main() {
  const afm::Model mica;
  const double eta = 2.0;
  afm::Tip tip(mica, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0});
  for (int i = 0; i < 2000; ++i) tip.advance({100000, 0.0});  // near the attractor: the guess

  const afm::PoincareMap map(mica, eta);
  const afm::OrbitResult found = afm::find_orbit(map, {tip.tip_state()});  // of one impact
  if (found.outcome != afm::OrbitOutcome::found) return 1;
  const afm::PeriodicOrbit& orbit = found.orbit;
  std::printf("# period %.17g tau, K_f %.17g m_tip/tau, residual %.17g\n", orbit.period, orbit.K_f, orbit.residual);
  for (const std::complex<double>& multiplier : orbit.multipliers) {
    std::printf("# multiplier %.17g %+.17gi\n", multiplier.real(), multiplier.imag());  // stable: all within 1
  }

  const afm::Flight<double> flight(afm::SpringConstants<double>(mica), eta, orbit.points.front());
  std::printf("time,extension,height,gap\n");  // [tau], [a]
  for (int i = 0; i <= 100; ++i) {
    const double s = orbit.period * i / 100;
    const afm::GapJet<double> jet = flight.gap(s);
    std::printf("%.17g,%.17g,%.17g,%.17g\n", s, jet.state.X, mica.y0 + jet.state.Y, jet.g);
  }
}
