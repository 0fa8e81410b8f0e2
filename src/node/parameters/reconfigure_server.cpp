#include "reconfigure_server.h"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>

#include <algorithm>
#include <string>

#include "node/wire/topics.h"

namespace afm::node {
namespace {

using dynamic_reconfigure::Config;

constexpr char kGroup[] = "Default";  // the name of the only group, as clients expect it

Config to_config(const LiveParameters& live) {
  Config config;
  for (const LiveField& field : kLiveFields) {
    dynamic_reconfigure::DoubleParameter value;
    value.name = field.name;
    value.value = live.*field.value;
    config.doubles.push_back(value);
  }
  dynamic_reconfigure::GroupState group;
  group.name = kGroup;
  group.state = 1;
  config.groups.push_back(group);
  return config;
}

dynamic_reconfigure::ConfigDescription describe(const Parameters& parameters) {
  dynamic_reconfigure::Group group;
  group.name = kGroup;
  for (const LiveField& field : kLiveFields) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = field.name;
    parameter.type = "double";
    parameter.description = field.description;
    group.parameters.push_back(parameter);
  }
  dynamic_reconfigure::ConfigDescription description;
  description.groups.push_back(group);
  description.min = to_config(least_live(parameters));
  description.max = to_config(most_live(parameters));
  description.dflt = to_config(live_parameters(parameters));
  return description;
}

std::string known_names() {
  std::string names;
  for (const LiveField& field : kLiveFields) names += (names.empty() ? "" : ", ") + std::string(field.name);
  return names;
}

// Values of another type than a number have no place here, whatever their name.
template <class Values>
void refuse(const Values& values, Faults& faults) {
  for (const auto& value : values)
    faults.push_back({value.name, "...", "cannot be changed live: only " + known_names()});
}

void read(const Config& config, LiveParameters& live, Faults& faults) {
  for (const auto& value : config.doubles) {
    const auto field = std::find_if(std::begin(kLiveFields), std::end(kLiveFields),
                                    [&](const LiveField& f) { return value.name == f.name; });
    if (field == std::end(kLiveFields)) {
      faults.push_back({value.name, std::to_string(value.value), "cannot be changed live: only " + known_names()});
    } else {
      live.*(field->value) = value.value;
    }
  }
  refuse(config.bools, faults);
  refuse(config.ints, faults);
  refuse(config.strs, faults);
}

}  // namespace

ReconfigureServer::ReconfigureServer(ros::NodeHandle& node, const Parameters& parameters, Refusals& refusals,
                                     Apply apply)
    : parameters_(parameters),
      refusals_(refusals),
      apply_(std::move(apply)),
      descriptions_(node.advertise<dynamic_reconfigure::ConfigDescription>(kDescriptionsTopic, 1, true)),
      updates_(node.advertise<Config>(kUpdatesTopic, 1, true)),
      service_(node.advertiseService(kSetParametersService, &ReconfigureServer::on_set, this)) {
  descriptions_.publish(describe(parameters));
  updates_.publish(to_config(live_parameters(parameters)));
}

Parameters ReconfigureServer::parameters() const {
  const std::lock_guard<std::mutex> lock(values_);
  return parameters_;
}

void ReconfigureServer::applied(const LiveParameters& live) {
  {
    const std::lock_guard<std::mutex> lock(values_);
    set_live(live, parameters_);
  }
  tell();
}

Config ReconfigureServer::tell() const {
  Config config = to_config(live_parameters(parameters()));
  updates_.publish(config);
  return config;
}

Faults ReconfigureServer::change(const Config& config) {
  Faults faults;
  Parameters changed = parameters();
  const LiveParameters before = live_parameters(changed);
  LiveParameters live = before;
  read(config, live, faults);
  if (!faults.empty()) return faults;
  set_live(live, changed);
  faults = find_faults(changed);
  if (!faults.empty() || live == before) return faults;
  const ControlReply reply = apply_(live);
  if (!reply.success) faults.push_back({"parameters", "as asked for", reply.message});
  return faults;
}

bool ReconfigureServer::on_set(dynamic_reconfigure::Reconfigure::Request& request,
                               dynamic_reconfigure::Reconfigure::Response& response) {
  const std::lock_guard<std::mutex> lock(changing_);
  const Faults faults = change(request.config);
  if (!faults.empty()) {
    const std::string reasons = node::describe(faults);
    refusals_.add(Refusal::faulty_change, reasons);
    ROS_WARN_STREAM("change of parameters refused: " << reasons);
  }
  response.config = tell();
  return true;
}

}  // namespace afm::node
