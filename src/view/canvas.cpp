#include "canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "afm/surface.h"

namespace afm::view {
namespace {

using visualization_msgs::Marker;

bool needs_points(const Marker& marker) { return marker.type != Marker::TEXT_VIEW_FACING; }

}  // namespace

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

geometry_msgs::Point Canvas::place(double x, double y, double depth) const {
  return point((x - origin_) * scale(), depth, y * scale());
}

double Canvas::over_cell(double x, std::size_t nth) const {
  return left() + static_cast<double>(nth % static_cast<std::size_t>(look_.cells)) + wrap_phase(x - left());
}

Marker Canvas::marker(const std::string& name, int type) const {
  Marker marker;
  marker.header.frame_id = "afm";
  marker.header.stamp = stamp_;
  marker.ns = name;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = tip_colour();
  return marker;
}

Marker& Canvas::add(const std::string& name, int type) {
  add(marker(name, type));
  return markers_.markers.back();
}

Marker& Canvas::add_text(const std::string& name, const std::string& text, const geometry_msgs::Point& where,
                         double height) {
  Marker& marker = add(name, Marker::TEXT_VIEW_FACING);
  marker.pose.position = where;
  marker.text = text;
  marker.color = text_colour();
  marker.scale.z = height;
  return marker;
}

void Canvas::wipe() { add("all", Marker::ARROW).action = Marker::DELETEALL; }

visualization_msgs::MarkerArray Canvas::finish() {
  for (Marker& marker : markers_.markers) {
    if (marker.action == Marker::DELETEALL) continue;
    const bool empty = needs_points(marker) ? marker.points.empty() : marker.text.empty();
    if (empty) marker.action = Marker::DELETE;
  }
  return std::move(markers_);
}

EnergyScale::EnergyScale(double energy_unit) : top_(std::pow(10.0, std::round(std::log10(energy_unit)) + 1.0)) {}

double EnergyScale::place(double energy) const {
  if (!(energy > 0.0)) return 0.0;
  return std::clamp(1.0 + std::log10(energy / top_) / kDecades, 0.0, 1.0);
}

std_msgs::ColorRGBA EnergyScale::colour_at(double place) {
  static const std::array<std_msgs::ColorRGBA, 8> steps = {
      colour(64, 88, 172),  colour(49, 104, 142), colour(38, 130, 142), colour(31, 158, 137),
      colour(53, 183, 121), colour(109, 205, 89), colour(180, 222, 44), colour(253, 231, 37)};
  const double along = std::clamp(place, 0.0, 1.0) * static_cast<double>(steps.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(along), steps.size() - 2);
  const auto part = static_cast<float>(along - static_cast<double>(below));
  const auto mix = [part](float a, float b) { return a + part * (b - a); };
  const std_msgs::ColorRGBA &a = steps[below], &b = steps[below + 1];
  std_msgs::ColorRGBA result = a;
  result.r = mix(a.r, b.r);
  result.g = mix(a.g, b.g);
  result.b = mix(a.b, b.b);
  return result;
}

}  // namespace afm::view
