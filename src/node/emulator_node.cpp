#include "emulator_node.h"

#include <ros/console.h>
#include <ros/this_node.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "node/wire/topics.h"

namespace afm::node {
namespace {

constexpr double kHandOverSeconds = 2.0;              // how far publishing may fall behind before stepping waits for it
constexpr double kHandOverSecondsAtMost = 0.5;        // and at the highest sample rate, if it was raised to that
constexpr std::size_t kMaxHandOverSamples = 2000000;  // 32 MB, if the batches themselves are not larger
constexpr std::size_t kMinBatches = 4;
constexpr std::size_t kMinHandOverImpacts = 200000;  // 11 MB: hundreds of batches of an ordinary run
constexpr double kDiskLookSeconds = 1.0;

std::size_t batches_in(double seconds, const Parameters& p) {
  const double seconds_per_batch = std::chrono::duration<double>(batch_period(p)).count();
  const auto wanted = static_cast<std::size_t>(seconds / seconds_per_batch);
  return std::max(kMinBatches, std::min(wanted, kMaxHandOverSamples / samples_per_batch(p)));
}

HandOver::Capacity hand_over_capacity(const Parameters& p) {
  Parameters fastest = p;  // the sample rate may rise while running
  fastest.sample_rate_hz = most_sample_rate(p);
  const std::size_t samples = std::max(batches_in(kHandOverSeconds, p) * samples_per_batch(p),
                                       batches_in(kHandOverSecondsAtMost, fastest) * samples_per_batch(fastest));
  // batches that spend their budget come in rows
  const std::size_t impacts = std::max<std::size_t>(kMinHandOverImpacts, 2 * p.impact_budget);
  return {std::max(batches_in(kHandOverSeconds, p), batches_in(kHandOverSeconds, fastest)), samples, impacts};
}

Recorder::Settings recorder_settings(const ros::NodeHandle& node, const Parameters& p) {
  const BagSeries::Topics topics{
      make_bag_topic<afm_emulator::Configuration>(node.resolveName(kConfigurationTopic), true),
      make_bag_topic<afm_emulator::Checkpoint>(node.resolveName(kCheckpointTopic), true),
      make_bag_topic<afm_emulator::AppliedDrag>(node.resolveName(kAppliedDragTopic), true),
      make_bag_topic<afm_emulator::AppliedParameters>(node.resolveName(kAppliedParametersTopic), true),
      make_bag_topic<afm_emulator::Recording>(node.resolveName(kRecordingTopic), false)};
  const auto bytes = [](double megabytes) { return static_cast<std::uint64_t>(megabytes * 1e6); };
  BagSeries::Settings settings{topics, bytes(p.disk_reserve_mb), bytes(p.split_size_mb), p.split_duration_s,
                               p.compression == "lz4" ? rosbag::compression::LZ4 : rosbag::compression::Uncompressed};
  return {p.bag_directory, settings};
}

}  // namespace

EmulatorNode::EmulatorNode(ros::NodeHandle node, const Parameters& parameters)
    : parameters_(parameters),
      disk_(parameters.bag_directory),
      recorder_(recorder_settings(node, parameters)),
      hand_over_(hand_over_capacity(parameters)),
      stepper_(parameters, hand_over_, demand_),
      control_(stepper_) {
  if (parameters.record) {
    const Recorder::Reply reply = recorder_.start("");
    if (!reply.success) throw std::runtime_error("record = true: " + reply.message);
  }
  disk_.measure();
  reconfigure_.emplace(node, parameters, refusals_,
                       [this](const LiveParameters& live) { return control_.change(live); });
  broadcaster_.emplace(node, parameters,
                       Broadcaster::Sources{hand_over_, recorder_, refusals_, disk_, demand_,
                                            [this](const Answer& answer) { control_.deliver(answer); },
                                            [this](const LiveParameters& live) { reconfigure_->applied(live); }});
  stepper_.start();
  broadcaster_->start(stepper_.scheduler());
  accept_commands(node);
  watch_master();
  if (parameters.bath.temperature_k > 0.0 && !emulator_settings(parameters).bath.is_on()) {
    ROS_WARN("temperature_k = %g has no effect: quality_factor is 0, so no heat reaches the tip",
             parameters.bath.temperature_k);
  }
  ROS_INFO("eta = %g, %g samples a second of model time, %lu to a batch, scheduler: %s",
           to_eta(parameters.drag_velocity, parameters.si), parameters.sample_rate_hz,
           static_cast<unsigned long>(samples_per_batch(parameters)), stepper_.scheduler().c_str());
}

EmulatorNode::~EmulatorNode() {
  master_watch_.reset();
  control_.close();  // services that wait for an answer return, and can then be shut down
  drag_velocity_.shutdown();
  rest_height_.shutdown();
  disk_look_.stop();
  reconfigure_->shutdown();
  for (ros::ServiceServer& service : services_) service.shutdown();
  stepper_.stop();
  if (broadcaster_) broadcaster_->stop();
}

void EmulatorNode::accept_commands(ros::NodeHandle& node) {
  drag_velocity_ = node.subscribe(kDragVelocityTopic, kCommandQueueSize, &EmulatorNode::on_drag_velocity, this,
                                  ros::TransportHints().tcpNoDelay());
  rest_height_ = node.subscribe(kRestHeightTopic, kCommandQueueSize, &EmulatorNode::on_rest_height, this,
                                ros::TransportHints().tcpNoDelay());
  disk_look_ = node.createWallTimer(ros::WallDuration(kDiskLookSeconds), [this](const auto&) { disk_.measure(); });
  services_.push_back(node.advertiseService(kPauseService, &EmulatorNode::on_pause, this));
  services_.push_back(node.advertiseService(kResetService, &EmulatorNode::on_reset, this));
  services_.push_back(node.advertiseService(kStepService, &EmulatorNode::on_step, this));
  services_.push_back(node.advertiseService(kStartRecordingService, &EmulatorNode::on_start_recording, this));
  services_.push_back(node.advertiseService(kStopRecordingService, &EmulatorNode::on_stop_recording, this));
}

void EmulatorNode::watch_master() {
  const std::string name = ros::this_node::getName();
  std::vector<std::string> names{name + "/get_loggers", name + "/set_logger_level"};  // roscpp's own
  names.push_back(name + "/" + kSetParametersService);
  for (const ros::ServiceServer& service : services_) names.push_back(service.getService());
  master_watch_.emplace(std::move(names));
}

void EmulatorNode::on_drag_velocity(const std_msgs::Float64& command) {
  const bool possible = std::abs(command.data) <= parameters_.max_drag_velocity;  // false for NaN
  obey(Request::Kind::drag, "drag_velocity", "m/s", command.data,
       possible ? "" : "must be finite and within max_drag_velocity");
}

void EmulatorNode::on_rest_height(const std_msgs::Float64& command) {
  SiModel lifted = parameters_.si;
  lifted.rest_height_m = command.data;
  const auto faults = find_faults(lifted);
  obey(Request::Kind::rest_height, "rest_height", "m", command.data, faults.empty() ? "" : faults.front().reason);
}

// `fault`: why not, or empty.
void EmulatorNode::obey(Request::Kind kind, const char* name, const char* unit, double value,
                        const std::string& fault) {
  Request request;
  request.kind = kind;
  request.value = value;
  if (fault.empty() && stepper_.submit(request)) return;
  std::ostringstream text;
  text << name << " = " << value << ' ' << unit << ": " << (fault.empty() ? "too many commands are waiting" : fault);
  refusals_.add(fault.empty() ? Refusal::overload : Refusal::faulty_command, text.str());
  ROS_WARN_STREAM_THROTTLE(1.0, "refused: " << text.str());
}

bool EmulatorNode::on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  const ControlReply reply = control_.pause(request.data != 0);
  response.success = reply.success;
  response.message = reply.message;
  return true;
}

bool EmulatorNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const ControlReply reply = control_.reset();
  response.success = reply.success;
  response.message = reply.message;
  return true;
}

bool EmulatorNode::on_step(afm_emulator::Step::Request& request, afm_emulator::Step::Response& response) {
  broadcaster_->look_for_listeners();  // one who has just come waits for this step
  const ControlReply reply = control_.step(request.tau, request.impacts);
  response.success = reply.success;
  response.message = reply.message;
  response.time = to_message(reply.time);
  return true;
}

// If nobody listened so far, no samples were taken: the recording begins behind the last batch that has none.
Recorder::Reply EmulatorNode::start_recording(const std::string& name) {
  broadcaster_->expect_recording(true);
  const ControlReply ready = control_.catch_up();
  Recorder::Reply reply{false, ready.message, ""};
  if (ready.success) reply = recorder_.start(name);
  broadcaster_->expect_recording(false);
  if (reply.success) broadcaster_->request_digest();  // from which the first stretch can be checked
  return reply;
}

bool EmulatorNode::on_start_recording(afm_emulator::StartRecording::Request& request,
                                      afm_emulator::StartRecording::Response& response) {
  const Recorder::Reply reply = start_recording(request.name);
  response.success = reply.success;
  response.message = reply.message;
  response.path = reply.path;
  return true;
}

bool EmulatorNode::on_stop_recording(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  if (!recorder_.status().recording.empty()) broadcaster_->request_digest();  // the last stretch can be checked too
  const Recorder::Reply reply = recorder_.stop();
  response.success = reply.success;
  response.message = reply.message;
  return true;
}

}  // namespace afm::node
