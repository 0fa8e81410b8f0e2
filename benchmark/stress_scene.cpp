#include "stress_scene.h"

#include <cmath>

namespace afm {

StressScene::StressScene(std::uint64_t seed, double contact_tolerance, bool mica)
    : seed_(seed),
      mica_(mica),
      random_(seed),
      model_(random_model()),
      eta_(random_eta()),
      tip_(model_, eta_, random_start(), contact_tolerance) {}

Model StressScene::random_model() {
  Model m;
  if (mica_) m.v_c = std::pow(10.0, within(-3.0, -1.0));
  if (mica_) return m;
  m.gamma = one_in(8) ? 0.0 : one_in(8) ? 1.0 : within(0.0, 1.0);
  m.v_c = one_in(8) ? 0.0 : std::pow(10.0, within(-4.0, 1.0));
  if (one_in(2)) m.y0 = one_in(4) ? 0.999999 * m.H : one_in(4) ? -10.0 : within(-1.0, m.H);
  if (one_in(4)) m.frequency_ratio = within(0.5, 20.0);
  return m;
}

double StressScene::random_eta() {
  if (one_in(10)) return 0.0;
  if (one_in(10)) return one_in(2) ? 1.0 : -1.0;
  // where the drag meets the horizontal spring most is lost, and most happens
  const double slow = mica_ && one_in(8) ? 6.0 : 0.0, fast = slow > 0.0 ? 6.5 : 9.0;
  const double size = mica_ ? within(slow, fast) : std::pow(10.0, within(-6.0, 2.0));
  return one_in(2) ? size : -size;
}

FreeState StressScene::random_start() {
  return {within(0.0, 1.0), within(-0.05, 0.05), model_.H + within(1e-6, 0.2), eta_ + within(-1.0, 1.0),
          within(-1.0, 1.0)};
}

bool StressScene::run(std::int64_t tau) {
  const ModelTime end{tau, 0.0};
  while (tip_.tip().now() < end) {
    if (!tip_.advance(tip_.tip().now() + std::exponential_distribution<double>(1.0)(random_))) return false;
    eta_ = one_in(20) ? eta_ : random_eta();  // the same again now and then
    tip_.drag(eta_);
  }
  return true;
}

std::string StressScene::report() const {
  return tip_.violation() + "\n  again by: --seed " + std::to_string(seed_) + (mica_ ? " --mica" : "") + " --scenes 1";
}

}  // namespace afm
