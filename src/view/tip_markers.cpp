#include "tip_markers.h"

#include <cmath>

#include "afm/detail/turns.h"
#include "palette.h"

namespace afm::view {
namespace {

using visualization_msgs::Marker;

constexpr double kPathDepth = -0.02, kTipDepth = -0.06;  // before the surface, which would hide them
constexpr int kConeSides = 16;
constexpr double kConeHeight = 0.5, kConeRadius = 0.13;
constexpr double kOldest = 0.15;  // opacity of the oldest part of the path

}  // namespace

void draw_path(Canvas& canvas, const std::vector<Corner>& path) {
  Marker& line = canvas.add("path", Marker::LINE_STRIP);
  line.scale.x = 0.03;
  if (path.size() < 2) return;
  const double span = path.back().time - path.front().time;
  for (const Corner& corner : path) {
    const double opacity = kOldest + (1.0 - kOldest) * (corner.time - path.front().time) / span;
    line.points.push_back(canvas.place(corner.x, corner.y, kPathDepth));
    line.colors.push_back(corner.contact ? contact_colour(opacity) : flight_colour(opacity));
  }
}

void draw_tip(Canvas& canvas, const Corner& tip) {
  Marker& cone = canvas.add("tip", Marker::TRIANGLE_LIST);
  const geometry_msgs::Point apex = canvas.place(tip.x, tip.y, kTipDepth);
  const auto rim = [&](int i) {
    const SinCos<double> turn = sin_cos_turns(1.0 * i / kConeSides);
    return point(apex.x + kConeRadius * turn.cos, apex.y + kConeRadius * turn.sin, apex.z + kConeHeight);
  };
  for (int i = 0; i < kConeSides; ++i) {
    for (const auto& corner : {apex, rim(i + 1), rim(i)}) cone.points.push_back(corner);
  }
  cone.color = tip.contact ? contact_colour() : tip_colour();
  canvas.add_text("contact", tip.contact ? "contact" : "", point(apex.x, apex.y, apex.z + kConeHeight + 0.15), 0.2);
}

void draw_spring(Canvas& canvas, const Corner& tip, double centre_x, double centre_y) {
  Marker& lines = canvas.add("spring", Marker::LINE_LIST);
  const geometry_msgs::Point centre = canvas.place(centre_x, centre_y, kPathDepth);
  const double arm = 0.07;
  lines.points = {centre,
                  canvas.place(tip.x, tip.y, kPathDepth),
                  point(centre.x - arm, centre.y, centre.z),
                  point(centre.x + arm, centre.y, centre.z),
                  point(centre.x, centre.y, centre.z - arm),
                  point(centre.x, centre.y, centre.z + arm)};
  lines.scale.x = 0.015;
  lines.color = spring_colour();
}

}  // namespace afm::view
