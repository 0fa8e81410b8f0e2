#include "canvas.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"

namespace afm::view {

constexpr std::size_t kMostMarkers = 64;  // so that a marker that was added stays where it is

Canvas::Canvas(double cells, double origin, ros::Time stamp) : cells_(cells), origin_(origin), stamp_(stamp) {
  markers_.markers.reserve(kMostMarkers);
}

geometry_msgs::Point Canvas::place(double x, double y, double depth) const {
  return point((x - origin_) * scale(), depth, y * scale());
}

double Canvas::over_cell(double x, std::size_t nth) const {
  return left() + static_cast<double>(nth % static_cast<std::size_t>(cells_)) + wrap_phase(x - left());
}

Marker& Canvas::add(const std::string& name, int type, const std_msgs::ColorRGBA& colour, double size) {
  Marker& marker = markers_.markers.emplace_back();
  marker.header.frame_id = "afm";
  marker.header.stamp = stamp_;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color = colour;
  return marker;
}

Marker& Canvas::add_text(const std::string& name, const std::string& text, const geometry_msgs::Point& where,
                         double height) {
  Marker& marker = add(name, Marker::TEXT_VIEW_FACING, text_colour(), height);
  marker.pose.position = where;
  marker.text = text;
  return marker;
}

visualization_msgs::MarkerArray Canvas::finish() {
  for (Marker& marker : markers_.markers) {
    if (marker.points.empty() && marker.text.empty() && marker.action == Marker::ADD) marker.action = Marker::DELETE;
  }
  return std::move(markers_);
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

std_msgs::ColorRGBA colour(double red, double green, double blue, double alpha) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(red / 255.0);
  result.g = static_cast<float>(green / 255.0);
  result.b = static_cast<float>(blue / 255.0);
  result.a = static_cast<float>(alpha);
  return result;
}

double top_of_scale(double energy_unit) { return std::pow(10.0, std::round(std::log10(energy_unit)) + 1.0); }

double place_on_scale(double energy, double energy_unit) {
  return energy > 0.0 ? std::clamp(1.0 + std::log10(energy / top_of_scale(energy_unit)) / kDecades, 0.0, 1.0) : 0.0;
}

// Without its darkest end, which would not show.
std_msgs::ColorRGBA colour_on_scale(double place) {
  constexpr int kSteps = 7;
  constexpr double kViridis[kSteps + 1][3] = {{64, 88, 172},  {49, 104, 142}, {38, 130, 142}, {31, 158, 137},
                                              {53, 183, 121}, {109, 205, 89}, {180, 222, 44}, {253, 231, 37}};
  const int below = std::min(static_cast<int>(place * kSteps), kSteps - 1);
  const double part = place * kSteps - below;
  const auto mix = [&](int i) { return kViridis[below][i] + part * (kViridis[below + 1][i] - kViridis[below][i]); };
  return colour(mix(0), mix(1), mix(2));
}

}  // namespace afm::view
