// Every marker is drawn on a canvas: the plane x-z of one frame. Surface and path of the tip have one scale.
#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

namespace afm::view {

using visualization_msgs::Marker;

constexpr double kWidth = 7.0;  // of the picture, in the units of its frame: sizes of symbols and texts go by it

class Canvas {
 public:
  // As many cells of the surface are seen across the picture, about the origin.
  Canvas(double cells, double origin, ros::Time stamp);

  double scale() const { return kWidth / cells_; }
  double left() const { return origin_ - 0.5 * cells_; }   // [a]
  double right() const { return origin_ + 0.5 * cells_; }  // [a]
  bool shows(double x) const { return left() <= x && x <= right(); }

  // A place over the surface [a], as far behind the picture's plane as is said, in units of the frame.
  geometry_msgs::Point place(double x, double y, double depth) const;
  // A place along the surface, moved by whole cells to lie over the nth of the cells seen.
  double over_cell(double x, std::size_t nth) const;

  // Adds a marker of its own name. One that gets no points, or no text, takes the place of the last one, unseen.
  Marker& add(const std::string& name, int type, const std_msgs::ColorRGBA& colour, double size = 1.0);
  Marker& add_text(const std::string& name, const std::string& text, const geometry_msgs::Point& where, double height);

  visualization_msgs::MarkerArray finish();

 private:
  double cells_, origin_;
  ros::Time stamp_;
  visualization_msgs::MarkerArray markers_;
};

geometry_msgs::Point point(double x, double y, double z);

// Colours that people with any kind of colour vision can distinguish.
std_msgs::ColorRGBA colour(double red, double green, double blue, double alpha = 1.0);  // 0 to 255; alpha 0 to 1

// Okabe and Ito's sky blue and vermilion, and greys for what does not move by itself.
inline std_msgs::ColorRGBA flight_colour(double alpha = 1.0) { return colour(86, 180, 233, alpha); }
inline std_msgs::ColorRGBA contact_colour(double alpha = 1.0) { return colour(230, 80, 0, alpha); }
inline std_msgs::ColorRGBA tip_colour() { return colour(240, 240, 240); }
inline std_msgs::ColorRGBA text_colour() { return colour(225, 225, 225); }
inline std_msgs::ColorRGBA spring_colour() { return colour(170, 170, 170, 0.8); }
inline std_msgs::ColorRGBA edge_colour() { return colour(200, 200, 205); }
inline std_msgs::ColorRGBA surface_colour() { return colour(62, 65, 74); }

// Energies lost, on a logarithmic scale of kDecades round decades about the natural unit of energy [J].
constexpr int kDecades = 4;
double top_of_scale(double energy_unit);                   // [J]
double place_on_scale(double energy, double energy_unit);  // 0 at its low end and below, 1 at its top and above
std_msgs::ColorRGBA colour_on_scale(double place);         // viridis: lighter is more at every step

}  // namespace afm::view
