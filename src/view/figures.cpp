#include <algorithm>
#include <cmath>

#include "scenery.h"
#include "text.h"

namespace afm::view {
namespace {

bool has_bath(const afm_emulator::Configuration& c) { return c.quality_factor > 0.0 || c.lateral_quality_factor > 0.0; }

// With a heat bath only the work of the drag gives the friction.
std::string friction_text(const afm_emulator::Friction& friction, bool by_work, const Units& units) {
  const double unit = units.friction(), K_f = (by_work ? friction.k_f_work : friction.k_f) / unit,
               error = (by_work ? friction.k_f_work_std_error : friction.k_f_std_error) / unit;
  if (std::isnan(K_f)) return "K_f: none at rest";
  if (std::isnan(error)) return text("K_f %.4f m_tip/tau", K_f);
  // two digits of the error
  const int decimals = static_cast<int>(std::clamp(1.0 - std::floor(std::log10(error)), 2.0, 6.0));
  return text("K_f %.*f +- %.*f m_tip/tau", decimals, K_f, decimals, error);
}

std::string bath_text(const afm_emulator::Configuration& c) {
  return has_bath(c) ? text("%.4g K, Q = %.4g; ", c.temperature_k, c.quality_factor) : "";
}

std::string speed_text(const Heard& heard, const Strobe& strobe) {
  const double scale = heard.configuration().time_scale;
  const std::string speed = scale == 1.0  ? "real time"
                            : scale < 1.0 ? text("%.6g times slower than real time", 1.0 / scale)
                                          : text("%.6g times faster than real time", scale);
  if (!heard.knows_place()) return speed + ": the first impact will tell where the surface is";
  if (strobe.frozen()) return speed + ": every picture taken over a crest; dots: the last second";
  return strobe.too_fast() ? speed + "; dots: the last second" : speed;
}

}  // namespace

void draw_figures(Canvas& canvas, const Heard& heard, const Strobe& strobe) {
  const double row = -0.72, height = 0.21;
  const double eta = heard.holder().eta(strobe.moment());
  canvas.add_text("drag", text("drag %.3f um/s", eta * heard.units().velocity() * 1e6), point(-2.45, 0.0, row), height);
  canvas.add_text("eta", text("eta %.3f", eta), point(-0.78, 0.0, row), height);
  const auto& friction = heard.friction();
  canvas.add_text("friction", friction ? friction_text(*friction, has_bath(heard.configuration()), heard.units()) : "",
                  point(1.75, 0.0, row), height);
  const ModelTime& now = strobe.moment();
  canvas.add_text("time",
                  text("%lld tau; %s%s", static_cast<long long>(now.tau), bath_text(heard.configuration()).c_str(),
                       speed_text(heard, strobe).c_str()),
                  point(0.0, 0.0, row - 0.35), 0.16);
}

}  // namespace afm::view
