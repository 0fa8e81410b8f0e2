// What every marker is drawn on: the plane x-z of one frame, lengths of the surface and of the tip's way to one scale.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

namespace afm::view {

// How much is seen, and of what size.
struct Look {
  std::string frame = "afm";
  double cells = 6.0;  // of the surface, across the picture
};

constexpr double kWidth = 7.0;  // of the picture, in the units of its frame: sizes of symbols and texts go by it

class Canvas {
 public:
  Canvas(const Look& look, ros::Time stamp) : look_(look), stamp_(stamp) {}

  void set_origin(double x) { origin_ = x; }
  double scale() const { return kWidth / look_.cells; }
  double left() const { return origin_ - 0.5 * look_.cells; }   // [a]
  double right() const { return origin_ + 0.5 * look_.cells; }  // [a]
  bool shows(double x) const { return left() <= x && x <= right(); }

  // A place over the surface [a], as far behind the picture's plane as is said, in units of the frame.
  geometry_msgs::Point place(double x, double y, double depth) const;

  // Adds a marker of its own name; one that has no points takes the place of the last one and is not seen.
  visualization_msgs::Marker& add(const std::string& name, int type);
  visualization_msgs::Marker& add_text(const std::string& name, const std::string& text,
                                       const geometry_msgs::Point& where, double height);

  // Takes away whatever earlier pictures left.
  void wipe();

  visualization_msgs::MarkerArray finish();

 private:
  Look look_;
  ros::Time stamp_;
  double origin_ = 0.0;
  visualization_msgs::MarkerArray markers_;
};

geometry_msgs::Point point(double x, double y, double z);

}  // namespace afm::view
