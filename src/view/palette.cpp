#include "palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace afm::view {

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
