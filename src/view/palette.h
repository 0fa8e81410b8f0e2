// Colours that people with any kind of colour vision can distinguish.
#pragma once

#include <std_msgs/ColorRGBA.h>

namespace afm::view {

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
