// What the example controllers share: commands that wait until they have taken effect, and mean lateral forces.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

inline std_msgs::Float64 to_message(double value) {
  std_msgs::Float64 message;
  message.data = value;
  return message;
}

// Callbacks run only inside its functions. Where the node is shut down meanwhile, they return at once.
class Client {
 public:
  // A value in force, and the model time from which on it holds.
  struct Applied {
    double value = NAN;
    std::uint32_t epoch = 0;
    afm_emulator::ModelTime time;
  };

  explicit Client(const std::string& name)
      : drag_publisher_(node_.advertise<std_msgs::Float64>(name + "/drag_velocity", 10)),
        height_publisher_(node_.advertise<std_msgs::Float64>(name + "/rest_height", 10)) {
    subscribe<afm_emulator::Configuration>(name + "/configuration", [this](const auto& m) { configuration_ = m; });
    subscribe<afm_emulator::AppliedDrag>(name + "/applied_drag", [this](const auto& m) {
      drag_ = {m->drag_velocity, m->epoch, m->time};
    });
    subscribe<afm_emulator::AppliedParameters>(name + "/applied_parameters", [this](const auto& m) {
      height_ = {m->rest_height_m, m->epoch, m->time};
    });
    subscribe<afm_emulator::Deflection>(name + "/deflection", [this](const auto& m) { batch_ = m; });
    wait_for([this] { return configuration_ && !std::isnan(height_.value); });
  }

  double rest_height() const { return height_.value; }  // [m]

  // Waits until it has taken effect.
  Applied set_drag_velocity(double metres_per_second) { return command(drag_publisher_, drag_, metres_per_second); }
  Applied set_rest_height(double metres) { return command(height_publisher_, height_, metres); }

  // Mean force of the holder on the tip along +x [N], k_h = m omega_h^2 times minus the extension. The window begins
  // settle_s of model time after the command. Nothing if the emulator was reset meanwhile.
  std::optional<double> mean_force(const Applied& applied, double settle_s, double window_s) {
    const double tau_s = 2.0 * M_PI / configuration_->omega_v_rad_per_s;
    double total = 0.0, seconds = 0.0;
    while (seconds < window_s) {
      batch_.reset();
      if (!wait_for([this] { return batch_ != nullptr; }) || batch_->epoch > applied.epoch) return std::nullopt;
      const auto& begin = batch_->time;
      const auto tau = static_cast<double>(begin.tau - applied.time.tau) + (begin.phase - applied.time.phase);
      if (batch_->epoch != applied.epoch || tau * tau_s < settle_s) continue;
      for (const double extension : batch_->lateral) total += extension * batch_->sample_period;
      seconds += static_cast<double>(batch_->lateral.size()) * batch_->sample_period;
    }
    return -configuration_->tip_mass_kg * std::pow(configuration_->omega_h_rad_per_s, 2) * total / seconds;
  }

 private:
  static constexpr double kAgain = 1.0;  // [s] a command without effect is sent again: the emulator may have restarted
  static constexpr double kPatience = 10.0;  // [s] then it counts as refused

  template <class Message, class Take>
  void subscribe(const std::string& topic, Take take) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback = take;
    subscribers_.push_back(node_.subscribe<Message>(topic, 1000, callback, {}, ros::TransportHints().tcpNoDelay()));
  }

  // Whether it came true in that time. Looks again after every message.
  template <class Condition>
  bool wait_for(Condition is_true, double seconds = INFINITY) {
    const double end = ros::WallTime::now().toSec() + seconds;
    while (ros::ok() && !is_true() && ros::WallTime::now().toSec() < end)
      ros::getGlobalCallbackQueue()->callOne(ros::WallDuration(0.05));
    return ros::ok() && is_true();
  }

  static bool is_earlier(const Applied& a, const Applied& b) {
    return std::make_tuple(a.epoch, a.time.tau, a.time.phase) < std::make_tuple(b.epoch, b.time.tau, b.time.phase);
  }

  // The emulator reports changes alone. If the value holds already, it is the time of the newest report or batch.
  Applied command(const ros::Publisher& publisher, const Applied& applied, double value) {
    const auto holds = [&] { return applied.epoch == configuration_->epoch && applied.value == value; };
    if (holds()) {
      batch_.reset();
      if (!wait_for([this] { return batch_ != nullptr; })) return applied;
      return std::max({drag_, height_, Applied{value, batch_->epoch, batch_->time}}, is_earlier);
    }
    const double end = ros::WallTime::now().toSec() + kPatience;
    while (ros::ok() && !holds()) {
      if (ros::WallTime::now().toSec() > end)
        throw std::runtime_error(publisher.getTopic() + ": " + std::to_string(value) + " had no effect: refused?");
      publisher.publish(to_message(value));
      wait_for(holds, kAgain);
    }
    return applied;
  }

  ros::NodeHandle node_;
  ros::Publisher drag_publisher_, height_publisher_;
  std::vector<ros::Subscriber> subscribers_;
  afm_emulator::Configuration::ConstPtr configuration_;
  afm_emulator::Deflection::ConstPtr batch_;  // the latest
  Applied drag_, height_;
};
