#include "live_server.h"

#include <ros/console.h>

namespace afm::node {
namespace {

void copy(const Live& live, afm_emulator::EmulatorConfig& config) {
  for (const LiveField& field : kLiveFields) config.*field.config = live.*field.value;
}

bool differ(const Live& a, const Live& b) {
  for (const LiveField& field : kLiveFields) {
    if (a.*field.value != b.*field.value) return true;
  }
  return false;
}

}  // namespace

// The server begins with the values of the parameter server, cut to the ranges of its sliders: the first call of change()
// puts those in force back.
LiveServer::LiveServer(const ros::NodeHandle& node, const Parameters& parameters, Refusals& refusals, Apply apply)
    : start_(parameters),
      refusals_(refusals),
      apply_(std::move(apply)),
      in_force_(live_of(parameters)),
      server_(server_mutex_, node) {
  server_.setCallback([this](Config& config, std::uint32_t) { show(config); });
  server_.setCallback([this](Config& config, std::uint32_t) { change(config); });
}

void LiveServer::applied(const Live& live) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_news_ = is_news_ || differ(live, in_force_);
  in_force_ = live;
}

void LiveServer::update_clients() {
  const boost::recursive_mutex::scoped_lock server_lock(server_mutex_);
  Config config;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!is_news_) return;
    show(config);
  }
  server_.updateConfig(config);
}

// What the server is given, and gives back with changes of a client in it.
void LiveServer::show(Config& config) {
  copy(in_force_, config);
  shown_ = config;
  is_news_ = false;
}

std::string LiveServer::find_fault(const Live& live) const {
  Parameters changed = start_;
  set_live(live, changed);
  return describe(find_faults(changed));
}

void LiveServer::change(Config& config) {
  Live live;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    live = in_force_;
    // What the client did not ask for is as it was shown, perhaps cut to the range of its slider; more may be in force.
    Config cut = shown_;
    cut.__clamp__();
    for (const LiveField& field : kLiveFields) {
      const double asked = config.*field.config;
      if (asked != shown_.*field.config && asked != cut.*field.config) live.*field.value = asked;
    }
    if (!differ(live, in_force_)) return show(config);
  }
  std::string fault = find_fault(live);
  if (fault.empty()) fault = apply_(live);
  if (!fault.empty()) {
    refusals_.add(Refusal::faulty_change, fault);
    ROS_WARN_STREAM("change of parameters refused: " << fault);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  show(config);
}

}  // namespace afm::node
