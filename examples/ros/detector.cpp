// A detector: what an instrument would give of ~deflection. Light on a photodiode has a calibration, white noise and a
// range, and a converter has bits. Publishes volts on ~volts (std_msgs/Float64MultiArray, the two channels vertical and
// lateral one after the other, a message for each batch).
// Parameters: emulator, vertical_v_per_nm, lateral_v_per_nm, noise_v_per_sqrt_hz, range_v, bits, seed.
#include <afm_emulator/Deflection.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace {

std_msgs::MultiArrayDimension dimension(const std::string& label, std::size_t size, std::size_t stride) {
  std_msgs::MultiArrayDimension result;
  result.label = label;
  result.size = static_cast<std::uint32_t>(size);
  result.stride = static_cast<std::uint32_t>(stride);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "detector");
  ros::NodeHandle node, own("~");
  const double vertical = own.param("vertical_v_per_nm", 0.05), lateral = own.param("lateral_v_per_nm", 0.01);
  const double density = own.param("noise_v_per_sqrt_hz", 5e-6);  // 0.1 pm per root Hz of vertical deflection
  const double range = own.param("range_v", 10.0);
  const double step = 2.0 * range / std::exp2(own.param("bits", 16));
  std::mt19937_64 random(static_cast<std::uint64_t>(own.param("seed", 1)));
  std::normal_distribution<double> normal;
  const ros::Publisher volts = own.advertise<std_msgs::Float64MultiArray>("volts", 100);

  const auto measure = [&](const afm_emulator::Deflection::ConstPtr& batch) {
    // white noise up to half the sample rate: its variance is the density squared times that bandwidth
    const double noise = density * std::sqrt(0.5 / batch->sample_period);
    std_msgs::Float64MultiArray message;
    const auto add = [&](const std::vector<double>& deflection, double v_per_nm) {
      for (const double metres : deflection) {
        const double v = std::clamp(1e9 * metres * v_per_nm + noise * normal(random), -range, range);
        message.data.push_back(std::nearbyint(v / step) * step);
      }
    };
    add(batch->vertical, vertical);
    add(batch->lateral, lateral);
    const std::size_t samples = batch->vertical.size();
    message.layout.dim = {dimension("channel", 2, 2 * samples), dimension("sample", samples, samples)};
    volts.publish(message);
  };
  const ros::Subscriber subscriber = node.subscribe<afm_emulator::Deflection>(
      own.param<std::string>("emulator", "/afm") + "/deflection", 100, measure, {}, ros::TransportHints().tcpNoDelay());
  ros::spin();
  return 0;
}
