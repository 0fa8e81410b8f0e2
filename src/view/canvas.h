// Every marker is drawn on a canvas: the plane x-z of one frame. Surface and path of the tip have one scale.
#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

namespace afm::view {

// How much is seen, and of what size.
struct Look {
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

  // A place along the surface, moved by whole cells to lie over the nth of the cells seen.
  double over_cell(double x, std::size_t nth) const;

  visualization_msgs::Marker marker(const std::string& name, int type) const;
  void add(const visualization_msgs::Marker& marker) { markers_.markers.push_back(marker); }
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

// Colours that people with any kind of colour vision can distinguish.
inline std_msgs::ColorRGBA colour(int red, int green, int blue, double alpha = 1.0) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(red) / 255.0F;
  result.g = static_cast<float>(green) / 255.0F;
  result.b = static_cast<float>(blue) / 255.0F;
  result.a = static_cast<float>(alpha);
  return result;
}

// Okabe and Ito's sky blue and vermilion, and greys for what does not move by itself.
inline std_msgs::ColorRGBA flight_colour(double alpha = 1.0) { return colour(86, 180, 233, alpha); }
inline std_msgs::ColorRGBA contact_colour(double alpha = 1.0) { return colour(230, 80, 0, alpha); }
inline std_msgs::ColorRGBA tip_colour() { return colour(240, 240, 240); }
inline std_msgs::ColorRGBA text_colour() { return colour(225, 225, 225); }
inline std_msgs::ColorRGBA spring_colour() { return colour(170, 170, 170, 0.8); }
inline std_msgs::ColorRGBA edge_colour() { return colour(200, 200, 205); }
inline std_msgs::ColorRGBA surface_colour() { return colour(62, 65, 74); }

// Energies lost, on a logarithmic scale of round decades about the natural unit of energy.
class EnergyScale {
 public:
  static constexpr int kDecades = 4;

  explicit EnergyScale(double energy_unit);  // [J]

  double top() const { return top_; }  // [J]
  // 0 at the low end and below it (and for no energy at all), 1 at the top and above it.
  double place(double energy) const;
  // Viridis without its darkest end, which would not show: lighter is more at every step.
  static std_msgs::ColorRGBA colour_at(double place);

 private:
  double top_;
};

}  // namespace afm::view
