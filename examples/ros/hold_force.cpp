// A controller: holds the mean lateral force by commanding ~rest_height, the normal load.
//
// Friction is not monotonic in the load, so the height stays within limits between which force rises as the tip is
// lowered (docs/temperature.md, "Load"). Publishes the measured force [N] on ~measured_force and the height [m] on
// ~commanded_height.
// Parameters: emulator, force [N], gain [m/N], lowest and highest height [m], settle_s and window_s of model time.
#include <afm_emulator/client.h>

#include <algorithm>
#include <cstdio>

using afm_emulator::number_parameter;
using afm_emulator::to_message;

int main(int argc, char** argv) try {
  ros::init(argc, argv, "hold_force");
  ros::NodeHandle own("~");
  const double setpoint = number_parameter(own, "force", 60e-12);
  const double gain = number_parameter(own, "gain", 1.0);  // half of 1 / (dF / d height): 0.45 N/m at eta = 3.4
  const double lowest = number_parameter(own, "lowest", -0.33e-9), highest = number_parameter(own, "highest", -0.03e-9);
  const double settle = number_parameter(own, "settle_s", 0.02), window = number_parameter(own, "window_s", 0.1);
  const ros::Publisher measured = own.advertise<std_msgs::Float64>("measured_force", 10);
  const ros::Publisher commanded = own.advertise<std_msgs::Float64>("commanded_height", 10);
  afm_emulator::Client tip(own.param<std::string>("emulator", "afm"));
  double height = std::clamp(tip.applied().rest_height_m, lowest, highest);
  while (ros::ok()) {
    const double force = tip.mean_force(window, settle, tip.kAsItIs, height);
    measured.publish(to_message(force));
    commanded.publish(to_message(height));
    ROS_INFO("force %.1f pN, height %.1f pm", 1e12 * force, 1e12 * height);
    const double before = height;
    height = std::clamp(height - gain * (setpoint - force), lowest, highest);  // a lower holder presses harder
    if (height == before) {
      ROS_WARN("the height is at its limit; the force is %.1f pN, not %.1f", 1e12 * force, 1e12 * setpoint);
    }
  }
  return 0;
} catch (const afm_emulator::Shutdown&) {
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hold_force: %s\n", error.what());  // roscpp's log ends with the last node handle
  return 1;
}
