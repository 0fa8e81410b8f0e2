// A controller: seeks the drag velocity with the greatest friction by commanding ~drag_velocity (extremum seeking).
//
// Measures the mean lateral force a little below and a little above the present speed, and goes to where it is greater.
// The step is proportional to the relative difference, so it vanishes at the peak. Publishes the speed [m/s] on ~speed.
// Parameters: emulator, start, dither, gain, lowest and highest speed [m/s], settle_s and window_s of model time.
#include <afm_emulator/client.h>

#include <algorithm>

using afm_emulator::to_message;

int main(int argc, char** argv) try {
  ros::init(argc, argv, "seek_peak");
  ros::NodeHandle own("~");
  constexpr double kEta = 3.3104228e-6;  // [m/s] of eta = 1 (mica), for the defaults
  double speed = own.param("start", 1.75 * kEta);
  const double dither = own.param("dither", 0.05 * kEta), gain = own.param("gain", 0.2 * kEta);
  const double lowest = own.param("lowest", 1.2 * kEta), highest = own.param("highest", 3.0 * kEta);
  const double settle = own.param("settle_s", 0.02), window = own.param("window_s", 0.1);
  const ros::Publisher published = own.advertise<std_msgs::Float64>("speed", 10);
  afm_emulator::Client tip(own.param<std::string>("emulator", "/afm"));
  while (ros::ok()) {
    const double below = tip.mean_force(window, settle, speed - dither);
    const double above = tip.mean_force(window, settle, speed + dither);
    published.publish(to_message(speed));
    ROS_INFO("speed %.3f um/s: force %.1f pN below it, %.1f pN above", 1e6 * speed, 1e12 * below, 1e12 * above);
    const double total = std::abs(below) + std::abs(above);
    if (total > 0.0) speed = std::clamp(speed + gain * (above - below) / total, lowest, highest);
  }
  return 0;
} catch (const afm_emulator::Shutdown&) {
  return 0;
} catch (const std::exception& error) {
  ROS_FATAL("%s", error.what());
  return 1;
}
