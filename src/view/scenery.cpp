#include <algorithm>
#include <cmath>
#include <cstdio>

#include "afm/surface.h"
#include "picture.h"

namespace afm::view {
namespace {

constexpr double kCornersPerCell = 24.0;
constexpr double kThickness = 0.25;    // of the block under the surface
constexpr double kEdgeDepth = -0.005;  // before the block, which would hide half of it
constexpr double kKeyLeft = -1.7, kKeyRight = 1.7, kKeyTop = -1.4, kKeyBottom = -1.52;
constexpr double kKeySteps = 64;

// printf into a string; what does not fit is cut off.
template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[200] = {};
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// From a line down to the bottom.
void add_quad(Marker& marker, geometry_msgs::Point a, geometry_msgs::Point b, double bottom,
              const std_msgs::ColorRGBA& colour) {
  a.y = b.y = 0.0;
  const auto under = [bottom](const geometry_msgs::Point& p) { return point(p.x, p.y, bottom); };
  for (const auto& corner : {a, under(a), under(b), a, under(b), b}) {
    marker.points.push_back(corner);
    marker.colors.push_back(colour);
  }
}

void draw_surface(Canvas& canvas, const Model& model) {
  Marker& edge = canvas.add("surface", Marker::LINE_STRIP, edge_colour(), 0.02);
  Marker& block = canvas.add("block", Marker::TRIANGLE_LIST, surface_colour());
  const double bottom = -model.H * canvas.scale() - kThickness;
  const int steps = static_cast<int>(std::ceil((canvas.right() - canvas.left()) * kCornersPerCell));
  for (int i = 0; i <= steps; ++i) {
    const double x = canvas.left() + (canvas.right() - canvas.left()) * i / steps;
    edge.points.push_back(canvas.place(x, surface_jet(model.H, x).h, kEdgeDepth));
    if (i > 0) add_quad(block, edge.points[i - 1], edge.points[i], bottom, surface_colour());
  }
}

void draw_length_scale(Canvas& canvas, const Units& units) {
  const double left = -3.3, right = left + canvas.scale(), z = kKeyTop;
  canvas.add("length_scale", Marker::LINE_STRIP, text_colour(), 0.03).points = {point(left, 0, z), point(right, 0, z)};
  canvas.add_text("length", text("%.3g nm", units.length() * 1e9), point(0.5 * (left + right), 0, z - 0.17), 0.15);
}

void draw_key(Canvas& canvas, const Units& units) {
  Marker& bar = canvas.add("key", Marker::TRIANGLE_LIST, text_colour());
  const auto along = [](double part) { return point(kKeyLeft + (kKeyRight - kKeyLeft) * part, 0.0, kKeyTop); };
  for (double i = 0; i < kKeySteps; ++i) {
    add_quad(bar, along(i / kKeySteps), along((i + 1) / kKeySteps), kKeyBottom, colour_on_scale((i + 0.5) / kKeySteps));
  }
  const double top = top_of_scale(units.energy()) * 1e21;
  for (int decade = 0; decade <= kDecades; ++decade) {
    canvas.add_text("key_" + std::to_string(decade), text("%g", top * std::pow(10.0, decade - kDecades)),
                    point(along(1.0 * decade / kDecades).x, 0.0, kKeyBottom - 0.13), 0.14);
  }
  canvas.add_text("key_title", "energy lost in an impact [zJ]", point(0.0, 0.0, kKeyBottom - 0.35), 0.15);
  const double right = 2.75, row = 0.22, height = 0.16;
  canvas.add_text("key_flight", "flight", point(right, 0.0, kKeyTop), height).color = flight_colour();
  canvas.add_text("key_contact", "contact", point(right, 0.0, kKeyTop - row), height).color = contact_colour();
  canvas.add_text("key_holder", "+ holder", point(right, 0.0, kKeyTop - 2.0 * row), height).color = spring_colour();
}

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

std::string speed_text(double scale, bool is_cloud) {
  const std::string speed = scale == 1.0  ? "real time"
                            : scale < 1.0 ? text("%.6g times slower than real time", 1.0 / scale)
                                          : text("%.6g times faster than real time", scale);
  return is_cloud ? speed + "; dots: the last second" : speed;
}

void draw_figures(Canvas& canvas, const RunView& run, bool is_cloud) {
  const double row = -0.72, height = 0.21, eta = run.eta();
  canvas.add_text("drag", text("drag %.1f nm/s", eta * run.units().velocity() * 1e9), point(-2.45, 0.0, row), height);
  canvas.add_text("eta", text("eta %.3f", eta), point(-0.78, 0.0, row), height);
  const auto& friction = run.friction();
  canvas.add_text("friction", friction ? friction_text(*friction, run.units()) : "", point(1.75, 0.0, row), height);
  canvas.add_text("time",
                  text("%lld tau; %s%s", static_cast<long long>(run.now().tau), bath_text(run.applied()).c_str(),
                       speed_text(run.configuration().time_scale, is_cloud).c_str()),
                  point(0.0, 0.0, row - 0.35), 0.16);
}

}  // namespace

void draw_scenery(Canvas& canvas, const RunView& run, bool is_cloud) {
  draw_surface(canvas, run.model());
  draw_length_scale(canvas, run.units());
  draw_key(canvas, run.units());
  draw_figures(canvas, run, is_cloud);
}

}  // namespace afm::view
