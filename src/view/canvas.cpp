#include "canvas.h"

#include "palette.h"

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

Marker& Canvas::add(const std::string& name, int type) {
  markers_.markers.emplace_back();
  Marker& marker = markers_.markers.back();
  marker.header.frame_id = look_.frame;
  marker.header.stamp = stamp_;
  marker.ns = name;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = tip_colour();
  return marker;
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

}  // namespace afm::view
