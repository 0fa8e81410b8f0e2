// A user's program: a thousand impacts of a tip, and flights through the library's templates, compiled here. To the bit.
#include <afm/afm.h>

#include <cstdio>

int main() {
  const afm::Model model;
  const double eta = 3.4;
  afm::Tip tip(model, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0});
  for (int i = 0; i < 1000; ++i) {
    tip.advance({1000000, 0.0});
    const afm::TipState state = tip.tip_state();
    const afm::Flight<double> flight(afm::Mechanics<double>(model), eta, state);
    std::printf("%a %a %a\n", state.phase, tip.last_impact().energy_loss, flight.gap(0.01 * i).g);
  }
}
