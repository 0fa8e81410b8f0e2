#include <algorithm>
#include <cmath>

#include "scenery.h"
#include "text.h"

namespace afm::view {
namespace {

// From the work of the drag, which defines friction with and without a heat bath.
std::string friction_text(const afm_emulator::Friction& friction, const Units& units) {
  const double K_f = friction.k_f_work_natural, error = friction.k_f_work_std_error / units.friction();
  if (std::isnan(K_f)) return "K_f: none at rest";
  if (std::isnan(error)) return text("K_f %.4f m_tip/tau", K_f);
  // two digits of the error
  const int decimals = static_cast<int>(std::clamp(1.0 - std::floor(std::log10(error)), 2.0, 6.0));
  return text("K_f %.*f +- %.*f m_tip/tau", decimals, K_f, decimals, error);
}

std::string bath_text(const afm_emulator::Applied& in_force) {
  const bool has_bath = in_force.quality_factor > 0.0 || in_force.lateral_quality_factor > 0.0;
  return has_bath ? text("%.4g K, Q = %.4g; ", in_force.temperature_k, in_force.quality_factor) : "";
}

std::string speed_text(const RunView& run, const Strobe& strobe) {
  const double scale = run.configuration().time_scale;
  const std::string speed = scale == 1.0  ? "real time"
                            : scale < 1.0 ? text("%.6g times slower than real time", 1.0 / scale)
                                          : text("%.6g times faster than real time", scale);
  if (strobe.frozen()) return speed + ": every picture taken over a crest; dots: the last second";
  return strobe.too_fast() ? speed + "; dots: the last second" : speed;
}

}  // namespace

void draw_figures(Canvas& canvas, const RunView& run, const Strobe& strobe) {
  const double row = -0.72, height = 0.21;
  const double eta = run.holder().eta(strobe.moment());
  canvas.add_text("drag", text("drag %.3f um/s", eta * run.units().velocity() * 1e6), point(-2.45, 0.0, row), height);
  canvas.add_text("eta", text("eta %.3f", eta), point(-0.78, 0.0, row), height);
  const auto& friction = run.friction();
  canvas.add_text("friction", friction ? friction_text(*friction, run.units()) : "",
                  point(1.75, 0.0, row), height);
  const ModelTime& now = strobe.moment();
  canvas.add_text("time",
                  text("%lld tau; %s%s", static_cast<long long>(now.tau), bath_text(run.applied()).c_str(),
                       speed_text(run, strobe).c_str()),
                  point(0.0, 0.0, row - 0.35), 0.16);
}

}  // namespace afm::view
