// dynamic_reconfigure: a change takes effect at the next batch boundary, and the reply follows it. A faulty combination
// puts the old values back; the log and /diagnostics say why.
#pragma once

#include <afm_emulator/EmulatorConfig.h>
#include <dynamic_reconfigure/server.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "node/params/advice.h"
#include "node/params/parameters.h"
#include "node/params/table.h"
#include "node/publisher/status.h"

namespace afm::node {

// The live parameters, all of them numbers. They are written to the parameter server by a call that does not repeat.
// roscpp's own call holds the lock of all parameters, and without a master it tries for ever. Diagnostics wait for that
// lock, and on ROS Noetic so does the message that the master is missing.
struct LiveConfig : afm_emulator::EmulatorConfig {
  LiveConfig() = default;
  LiveConfig(const EmulatorConfig& config) : EmulatorConfig(config) {}  // the server makes it of these

  // In the last message, which asks for these. What clients were shown may be a moment old: a value that equals it may
  // still be a change.
  std::set<std::string> named;

  // These three are in place of those of EmulatorConfig.
  bool __fromMessage__(dynamic_reconfigure::Config& message) {
    named.clear();
    for (const dynamic_reconfigure::DoubleParameter& parameter : message.doubles) named.insert(parameter.name);
    return EmulatorConfig::__fromMessage__(message);
  }
  void __clamp__() const {}  // a value is taken or refused as it is
  void __toServer__(const ros::NodeHandle& node) const {
    dynamic_reconfigure::Config values;
    __toMessage__(values);
    for (const dynamic_reconfigure::DoubleParameter& parameter : values.doubles) {
      XmlRpc::XmlRpcValue request, response, unused;
      request[0] = ros::this_node::getName();
      request[1] = node.resolveName(parameter.name);
      request[2] = parameter.value;
      ros::master::execute("setParam", request, response, unused, false);
    }
  }
};

class LiveServer {
 public:
  // What is asked for, and NaN where nothing is. Returns why the change did not take effect, or nothing when it has.
  using Apply = std::function<std::string(const Live& asked)>;

  // The server begins with the values of the parameter server; its first call puts those in force back. It holds its
  // mutex whenever it calls.
  LiveServer(const ros::NodeHandle& node, const Parameters& parameters, Refusals& refusals, Apply apply)
      : start_(parameters),
        refusals_(refusals),
        apply_(std::move(apply)),
        in_force_(parameters),
        server_(server_mutex_, node) {
    server_.setCallback([this](Config& config, std::uint32_t level) {
      constexpr std::uint32_t kFirstCall = ~0u;
      if (level != kFirstCall) change(config);
      config = shown_ = to_config(in_force());
      shown_twice_ = false;
    });
    show_ranges();
    // the height that was written beside it stands for it, also when the node starts again
    if (parameters.load_n != 0.0) node.deleteParam("load_n");
  }

  // Called with whatever was applied, by the publisher: a change waits for it, so it may not wait for a change.
  void applied(const Live& live) {
    const std::lock_guard<std::mutex> lock(mutex_);
    in_force_ = live;
  }

  // Shows clients what was applied; called now and then. It sends each message twice: roscpp's latch takes one after it
  // has been sent, and who subscribed between the two has the one before. Any other thread.
  void update_clients() {
    const boost::recursive_mutex::scoped_try_lock lock(server_mutex_);
    if (!lock) return;  // a change holds it until it has taken effect: after a step, which may take seconds
    const Config config = to_config(in_force());
    const bool is_shown = values_of(config) == values_of(shown_);
    if (is_shown && shown_twice_) return;
    shown_ = config;
    shown_twice_ = is_shown;
    server_.updateConfig(config);
  }

 private:
  using Config = LiveConfig;

  // Sliders that people can use: the speed and the load are those of the lever. A value beyond may be given.
  void show_ranges() {
    constexpr double kUsualDepth = 1e-9, kUsualHeight = 1e-10, kFastestCutoff = 0.6;  // m, m, a/tau
    Config least = Config::__getMin__(), most = Config::__getMax__();
    least.restitution_gamma = 0.0, most.restitution_gamma = 1.0;
    least.cutoff_speed = 0.0;
    most.cutoff_speed = std::max(kFastestCutoff * Units(start_.si).velocity(), 2.0 * start_.si.cutoff_speed);
    least.rest_height_m = std::min(-kUsualDepth, 2.0 * start_.si.rest_height_m);
    most.rest_height_m = std::max(kUsualHeight, 2.0 * start_.si.rest_height_m);
    least.sample_rate_hz = 1e3, most.sample_rate_hz = kMaxSampleRate;
    least.friction_window_tau = 10.0, most.friction_window_tau = 1e4;
    least.temperature_k = 0.0, most.temperature_k = std::max(400.0, start_.bath.temperature_k);
    least.quality_factor = 0.0, most.quality_factor = std::max(1000.0, start_.bath.quality_factor);
    least.lateral_quality_factor = 0.0;
    most.lateral_quality_factor = std::max(1000.0, start_.bath.lateral_quality_factor);
    least.kicks_per_tau = 1.0, most.kicks_per_tau = std::max(100.0, start_.bath.kicks_per_tau);
    server_.setConfigMin(least);
    server_.setConfigMax(most);
  }

  static Config to_config(const Live& live) {
    Config config;
    for_each_live(config, live, kToMessage);
    return config;
  }

  static std::vector<double> values_of(const Config& config) {
    Live unused;
    std::vector<double> values;
    for_each_live(config, unused, [&](double value, double) { values.push_back(value); });
    return values;
  }

  Live in_force() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return in_force_;
  }

  // Judged beside what was in force last: what waits for its batch may change that before it acts.
  void change(const Config& config) {
    if (config.named.empty()) return;
    const auto take = [&](Live& live) {
      auto name = std::begin(kLiveNames);
      for_each_live(config, live, [&](double asked, double& value) {
        if (config.named.count(*name++) > 0) value = asked;
      });
    };
    Live asked;
    for_each_live(config, asked, [](double, double& value) { value = std::numeric_limits<double>::quiet_NaN(); });
    take(asked);
    Parameters changed = start_;
    const Live before = in_force();
    live_of(changed) = before;
    take(changed);
    std::string fault = describe(find_faults(changed));
    if (fault.empty()) fault = apply_(asked);
    if (fault.empty()) return give_new_warnings(before, changed);
    refusals_.add(Refusal::faulty_change, fault);
    ROS_WARN_STREAM("change of parameters refused: " << fault);
  }

  void give_new_warnings(const Live& before, const Parameters& changed) const {
    Parameters was = start_;
    live_of(was) = before;
    const std::vector<std::string> known = find_warnings(was);
    for (const std::string& warning : find_warnings(changed)) {
      if (std::find(known.begin(), known.end(), warning) == known.end()) ROS_WARN_STREAM(warning);
    }
  }

  const Parameters start_;
  Refusals& refusals_;
  const Apply apply_;
  std::mutex mutex_;  // of in_force_
  Live in_force_;
  boost::recursive_mutex server_mutex_;  // also of shown_ and shown_twice_
  Config shown_;                         // to the clients
  bool shown_twice_ = false;
  dynamic_reconfigure::Server<Config> server_;
};

}  // namespace afm::node
