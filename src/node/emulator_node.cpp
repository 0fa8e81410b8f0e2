#include "emulator_node.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "afm/number_text.h"
#include "node/publisher/topics.h"
#include "node/recorder/paths.h"
#include "node/runner/trial.h"

namespace afm::node {
namespace {

constexpr double kQueueSeconds = 2.0;               // how far publishing may fall behind before the run waits for it
constexpr double kMaxQueueBytes = 512.0 * 1048576;  // of address space; only what is used is touched
constexpr double kMinBatches = 4.0;
constexpr double kSafePace = 1.2;  // of the trial run over what is needed: publishing and other programs take their part
constexpr double kDiskPeriod = 1.0, kClientsPeriod = 0.1;  // [s]
// A batch takes at most 1.5 s, and a step fails after 8 s.
constexpr std::chrono::seconds kAnswerDeadline{12};
constexpr std::chrono::microseconds kSpin{300};  // an idle processor takes 50 to 100 us to wake a thread
constexpr std::chrono::milliseconds kClosingPoll{50};  // how soon whoever waits learns that the node ends

std::size_t batches_in_queue(const Parameters& p, const Batch& largest) {
  const double bytes = static_cast<double>(largest.vertical.capacity() + largest.lateral.capacity()) * sizeof(double) +
                       static_cast<double>(largest.impacts.capacity()) * sizeof(Impact);
  const double wanted = kQueueSeconds / std::chrono::duration<double>(batch_period(p)).count();
  return static_cast<std::size_t>(std::max(kMinBatches, std::min(wanted, kMaxQueueBytes / bytes)));
}

Recorder::Settings recorder_settings(const Parameters& p) {
  const auto bytes = [](double megabytes) { return static_cast<std::uint64_t>(megabytes * 1e6); };
  return {p.bag_directory, bytes(p.disk_reserve_mb), bytes(p.split_size_mb), p.split_duration_s,
          p.compression == "lz4" ? rosbag::compression::LZ4 : rosbag::compression::Uncompressed};
}

std::string fault_of(const Answer& answer) {
  switch (answer.result) {
    case Answer::Result::done:
      return {};
    case Answer::Result::not_paused:
      return "the emulator is running: pause it first";
    case Answer::Result::not_lockstep:
      return "the emulator keeps time by itself: start it with pace = lockstep";
    case Answer::Result::shutting_down:
      return "the emulator is shutting down";
    case Answer::Result::time_ran_out:
      break;
  }
  return "time ran out after " + std::to_string(answer.impacts) + " impacts, at the time given";
}

std::string find_step_fault(double tau, std::uint32_t impacts) {
  std::ostringstream text;
  if (!std::isfinite(tau) || tau < 0.0 || tau > kMaxStepTau) {
    text << "tau = " << tau << ": must be between 0 and " << kMaxStepTau;
  } else if (impacts > kMaxStepImpacts) {
    text << "impacts = " << impacts << ": must be at most " << kMaxStepImpacts;
  } else if ((tau > 0.0) == (impacts > 0)) {
    text << "tau = " << tau << ", impacts = " << impacts << ": exactly one of them must be given, the other 0";
  }
  return text.str();
}

// The name of the node that publishes /clock already, or nothing.
std::string find_clock_publisher() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return {};
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i) {
    const std::string topic = publishers[i][0];
    if (topic == kClockTopic && publishers[i][1].size() > 0) return publishers[i][1][0];
  }
  return {};
}

// A run that cannot keep real time says so before it falls behind.
void foretell_pace(const Parameters& p) {
  const double pace = measure_pace(p);
  ROS_INFO("a trial run of this tip made %.3g times real time on this machine", pace);
  if (p.pace == kLockstep || pace > kSafePace * p.time_scale) return;
  ROS_WARN("this run will not keep its pace: time_scale = %g, and a trial run made %.2g times real time. Give time_scale = %.1g, "
           "a lower sample_rate_hz, a contact_tolerance up to 1e-2, or model = hammer",
           p.time_scale, pace, 0.7 * pace);
}

}  // namespace

EmulatorNode::EmulatorNode(ros::NodeHandle node, const Parameters& parameters)
    : parameters_(parameters),
      queue_(batches_in_queue(parameters, preallocated_batch(parameters)), preallocated_batch(parameters)),
      runner_(parameters, queue_),
      recorder_(recorder_settings(parameters), [this] { runner_.submit({Request::Kind::snapshot, 0.0, 0, {}, {}}); }) {
  if (parameters.publish_clock) {
    const std::string other = find_clock_publisher();
    if (!other.empty()) throw std::runtime_error("publish_clock = true: " + other + " publishes /clock already");
  }
  if (parameters.record) {
    const Recorder::Reply reply = recorder_.start("");
    if (!reply.success) throw std::runtime_error("record = true: " + reply.message);
  }
  free_bytes_ = free_bytes(parameters.bag_directory);
  foretell_pace(parameters);
  live_server_.emplace(node, parameters, refusals_, [this](const Live& live) {
    return ask({Request::Kind::change, 0.0, 0, live, {}}).fault;
  });
  publisher_.emplace(node, parameters, Publisher::Sources{queue_, recorder_, refusals_, free_bytes_, [this](const Live& live) {
                                                            live_server_->applied(live);
                                                          }});
  runner_.start();
  publisher_->start(runner_.scheduler());
  accept_commands(node);
  if (parameters.bath.temperature_k > 0.0 && !run_settings(parameters).bath.is_on()) {
    ROS_WARN("temperature_k = %g has no effect: quality_factor is 0, so no heat reaches the tip",
             parameters.bath.temperature_k);
  }
  ROS_INFO("tip: %g N/m at %g Hz, %g N/m laterally, effective mass %g kg; load %g N; tau = %g s", spring_constant(parameters.si),
           parameters.si.omega_v_rad_per_s / kTwoPi, parameters.si.tip_mass_kg * std::pow(parameters.si.omega_h_rad_per_s, 2),
           parameters.si.tip_mass_kg, 0.0 - spring_constant(parameters.si) * parameters.si.rest_height_m,
           Units(parameters.si).time());
  ROS_INFO("eta = %g, %g samples a second of model time, %lu to a batch, scheduler: %s",
           to_eta(parameters.drag_velocity, parameters.si), parameters.sample_rate_hz,
           static_cast<unsigned long>(samples_per_batch(parameters)), runner_.scheduler().c_str());
}

EmulatorNode::~EmulatorNode() {
  closing_ = true;  // services that wait for an answer return, and can then be shut down
  for (ros::Subscriber& subscriber : commands_) subscriber.shutdown();
  disk_timer_.stop();
  clients_timer_.stop();
  for (ros::ServiceServer& service : services_) service.shutdown();
  runner_.stop();
  publisher_->stop();
}

void EmulatorNode::accept_commands(ros::NodeHandle& node) {
  const auto hints = ros::TransportHints().tcpNoDelay();
  commands_ = {
      node.subscribe(kDragVelocityTopic, kCommandQueueSize, &EmulatorNode::on_drag_velocity, this, hints),
      node.subscribe(kRestHeightTopic, kCommandQueueSize, &EmulatorNode::on_rest_height, this, hints),
      node.subscribe(kLoadTopic, kCommandQueueSize, &EmulatorNode::on_load, this, hints)};
  services_ = {node.advertiseService(kPauseService, &EmulatorNode::on_pause, this),
               node.advertiseService(kResetService, &EmulatorNode::on_reset, this),
               node.advertiseService(kControlService, &EmulatorNode::on_control, this),
               node.advertiseService(kStepService, &EmulatorNode::on_step, this),
               node.advertiseService(kStartRecordingService, &EmulatorNode::on_start_recording, this),
               node.advertiseService(kStopRecordingService, &EmulatorNode::on_stop_recording, this)};
  disk_timer_ = node.createWallTimer(ros::WallDuration(kDiskPeriod), [this](const auto&) {
    free_bytes_ = free_bytes(parameters_.bag_directory);  // may wait for the disk
  });
  clients_timer_ = node.createWallTimer(ros::WallDuration(kClientsPeriod),
                                        [this](const auto&) { live_server_->update_clients(); });
}

void EmulatorNode::on_drag_velocity(const std_msgs::Float64& command) {
  const bool possible = std::abs(command.data) <= parameters_.max_drag_velocity;  // false for NaN
  submit_or_refuse({Request::Kind::drag, command.data, 0, {}, {}}, "drag_velocity", "m/s", command.data,
                   possible ? "" : "must be finite and within max_drag_velocity");
}

void EmulatorNode::on_rest_height(const std_msgs::Float64& command) {
  set_rest_height(Request::Kind::rest_height, "rest_height", "m", command.data, command.data);
}

void EmulatorNode::on_load(const std_msgs::Float64& command) {
  set_rest_height(Request::Kind::load, "load", "N", command.data, -command.data / spring_constant(parameters_.si));
}

void EmulatorNode::set_rest_height(Request::Kind kind, const char* name, const char* unit, double given,
                                   double rest_height) {
  SiModel si = parameters_.si;
  si.rest_height_m = rest_height;
  const auto faults = find_faults(si);
  submit_or_refuse({kind, rest_height, 0, {}, {}}, name, unit, given, faults.empty() ? "" : faults.front().reason);
}

// `fault`: why not, or empty.
void EmulatorNode::submit_or_refuse(const Request& request, const char* name, const char* unit, double given,
                                    const std::string& fault) {
  if (fault.empty() && runner_.submit(request)) return;
  std::ostringstream text;
  text << name << " = " << given << ' ' << unit << ": " << (fault.empty() ? "too many commands are waiting" : fault);
  refusals_.add(fault.empty() ? Refusal::overload : Refusal::faulty_command, text.str());
  ROS_WARN_STREAM_THROTTLE(1.0, "refused: " << text.str());
}

EmulatorNode::Outcome EmulatorNode::ask(Request request) {
  request.reply = std::make_shared<std::promise<Answer>>();
  std::future<Answer> answer = request.reply->get_future();
  if (!runner_.submit(request)) return {"too many requests are waiting", {}};
  const auto begin = std::chrono::steady_clock::now(), give_up = begin + kAnswerDeadline;
  while (answer.wait_for(std::chrono::seconds(0)) != std::future_status::ready &&
         std::chrono::steady_clock::now() - begin < kSpin) {
    std::this_thread::yield();
  }
  while (answer.wait_for(kClosingPoll) != std::future_status::ready) {
    if (closing_) return {"the emulator is shutting down", {}};
    if (std::chrono::steady_clock::now() > give_up) {
      return {"no answer from the running thread in time; it may still come to it", {}};
    }
  }
  const Answer given = answer.get();
  return {fault_of(given), given};
}

bool EmulatorNode::on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  const bool paused = request.data != 0;
  const Outcome outcome = ask({paused ? Request::Kind::pause : Request::Kind::resume, 0.0, 0, {}, {}});
  response.success = outcome.fault.empty();
  response.message = response.success ? (paused ? "paused" : "running") : outcome.fault;
  return true;
}

bool EmulatorNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Outcome outcome = ask({Request::Kind::reset, 0.0, 0, {}, {}});
  response.success = outcome.fault.empty();
  response.message = response.success ? "model time 0, initial state, start parameters, new epoch" : outcome.fault;
  return true;
}

bool EmulatorNode::on_step(afm_emulator::Step::Request& request, afm_emulator::Step::Response& response) {
  Outcome outcome{find_step_fault(request.tau, request.impacts), {}};
  if (outcome.fault.empty()) {
    const auto kind = request.impacts > 0 ? Request::Kind::step_impacts : Request::Kind::step_time;
    outcome = ask({kind, request.tau, request.impacts, {}, {}});
  }
  response.success = outcome.fault.empty();
  response.message = response.success ? (request.impacts > 0 ? "impact reached" : "time reached") : outcome.fault;
  response.time = to_message(outcome.answer.time);
  return true;
}

// Why a control period cannot be, or nothing.
std::string EmulatorNode::find_fault(const afm_emulator::Control::Request& request) const {
  const double most = kMaxStepTau * Units(parameters_.si).time();
  SiModel si = parameters_.si;
  if (!std::isnan(request.rest_height)) si.rest_height_m = request.rest_height;
  if (!std::isnan(request.drag_velocity) && !(std::abs(request.drag_velocity) <= parameters_.max_drag_velocity)) {
    return "drag_velocity = " + number_text(request.drag_velocity) + " m/s: must be within max_drag_velocity";
  }
  if (const auto faults = find_faults(si); !faults.empty()) {
    return "rest_height = " + number_text(request.rest_height) + " m: " + faults.front().reason;
  }
  if (request.duration >= 0.0 && request.duration <= most) return {};
  return "duration = " + number_text(request.duration) + " s: must be between 0 and " + number_text(most);
}

bool EmulatorNode::on_control(afm_emulator::Control::Request& request, afm_emulator::Control::Response& response) {
  const Units units(parameters_.si);
  Outcome outcome{find_fault(request), {}};
  if (outcome.fault.empty()) {
    Request period{Request::Kind::control, request.duration / units.time(), 0, {}, {}};
    period.live.drag_velocity = request.drag_velocity;
    period.live.rest_height_m = request.rest_height;
    outcome = ask(period);
  } else {
    refusals_.add(Refusal::faulty_command, outcome.fault);
  }
  response = to_control(outcome.answer, parameters_.si);
  response.success = outcome.fault.empty();
  response.message = response.success ? "time reached" : outcome.fault;
  return true;
}

// The recording begins with a snapshot that is taken for it.
bool EmulatorNode::on_start_recording(afm_emulator::StartRecording::Request& request,
                                      afm_emulator::StartRecording::Response& response) {
  const Recorder::Reply reply = recorder_.start(request.name);
  response.success = reply.success;
  response.message = reply.message;
  response.path = reply.path;
  if (!reply.success) return true;
  const Outcome begun = ask({Request::Kind::snapshot, 0.0, 0, {}, {}});
  if (begun.fault.empty()) return true;
  recorder_.stop();
  response.success = false;
  response.message = begun.fault;
  return true;
}

// All that was emulated until now belongs to it.
bool EmulatorNode::on_stop_recording(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  ask({Request::Kind::flush, 0.0, 0, {}, {}});
  const Recorder::Reply reply = recorder_.stop();
  response.success = reply.success;
  response.message = reply.message;
  return true;
}

}  // namespace afm::node
