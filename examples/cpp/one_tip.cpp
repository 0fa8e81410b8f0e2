// One tip from a start to a given time: where it is then, and the friction on the way.
#include <afm/afm.h>

#include <cstdio>

int main() {
  const afm::Model mica;   // the paper's values, in natural units: lattice spacing a, period tau, tip mass m
  const double eta = 3.4;  // drag velocity [a/tau]
  const afm::FreeState start{0.25, 0.0, 0.2, eta, 0.0};  // surface phase, extension, height, velocity
  afm::Tip tip(mica, eta, start);

  int events = 0;
  double energy_loss = 0.0;             // [m_tip a^2/tau^2]
  const afm::ModelTime end{1000, 0.0};  // whole tau, and a part of one
  while (tip.advance(end) != afm::Outcome::time_limit) {
    energy_loss += tip.last_impact().energy_loss;
    ++events;
  }

  const afm::FreeState state = tip.state();
  const double K_f = energy_loss / (eta * eta * (tip.now() - afm::ModelTime{}));  // Eq. 8 [m_tip/tau]
  const afm::Units units{afm::SiModel{}};
  std::printf("events %d\n", events);
  std::printf("phase %.17g a, extension %.17g a, height %.17g a\n", state.phase, state.X, state.y);
  std::printf("K_f %.17g m_tip/tau = %.17g kg/s\n", K_f, K_f * units.friction());
}
