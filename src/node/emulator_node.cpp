// emulator_node: the AFM tip on the wire. It connects ROS with the threads that run, publish and record. Exits 1 if its
// parameters are faulty, 0 when it is ordered to end.
#include <afm_emulator/Control.h>
#include <afm_emulator/StartRecording.h>
#include <afm_emulator/Step.h>
#include <malloc.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <clocale>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "afm/number_text.h"
#include "live_server.h"
#include "node/ending.h"
#include "node/params/advice.h"
#include "node/params/parameters.h"
#include "node/publisher/publisher.h"
#include "node/publisher/topics.h"
#include "node/recorder/recorder.h"
#include "node/runner/report.h"
#include "node/runner/runner.h"

namespace afm::node {
namespace {

using Kind = Request::Kind;

// A step may hold one service for seconds: others, and commands, must come through meanwhile. Control periods have
// threads of their own, as in real time each holds one until it is over; one more refuses what is too many.
constexpr unsigned kSpinnerThreads = 3, kControlThreads = kMaxPeriods + 1;
constexpr double kQueueSeconds = 2.0;               // how far publishing may fall behind before the run waits for it
constexpr double kMaxQueueBytes = 512.0 * 1048576;  // of address space; only what is used is touched
constexpr double kMinBatches = 4.0;                 // a choice: one is filled, one is published, two wait
constexpr double kClientsPeriod = 0.1;              // [s]
constexpr char kTooMany[] = "too many commands are waiting";
// A batch takes at most 1.5 s, and a step fails after 8 s.
constexpr std::chrono::seconds kAnswerDeadline{12};
// In lockstep an idle processor takes 50 to 100 us to wake a thread; in real time this would hold up the publisher.
constexpr std::chrono::microseconds kSpin{300};
constexpr std::chrono::milliseconds kClosingPoll{50};   // how soon whoever waits learns that the node ends
constexpr std::chrono::milliseconds kShutdownPoll{20};  // how soon a shutdown is noticed

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

std::string find_step_fault(double tau, std::uint32_t impacts) {
  std::ostringstream text;
  if (!std::isfinite(tau) || tau < 0.0 || tau > kMaxStepTau) {
    text << "tau = " << number_text(tau) << ": must be between 0 and " << kMaxStepTau;
  } else if (impacts > kMaxStepImpacts) {
    text << "impacts = " << impacts << ": must be at most " << kMaxStepImpacts;
  } else if ((tau > 0.0) == (impacts > 0)) {
    text << "tau = " << tau << ", impacts = " << impacts << ": exactly one of them must be given, the other 0";
  }
  return text.str();
}

// Throws if another node publishes /clock, or what it is remapped to.
void check_clock() {
  const std::string name = ros::this_node::getName(), clock = ros::names::resolve("/clock");
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = name;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return;
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i) {
    const std::string topic = publishers[i][0];
    for (int j = 0; topic == clock && j < publishers[i][1].size(); ++j) {
      const std::string other = publishers[i][1][j];
      if (other != name)
        throw std::runtime_error("publish_clock = true: " + other + " publishes " + clock + " already");
    }
  }
}

// A run that cannot keep real time says so before it falls behind.
void report_speed(const Parameters& p) {
  const double times_real_time = measure_times_real_time(p);
  ROS_INFO("a trial run of this tip made %.3g times real time on this machine", times_real_time);
  const std::string warning = find_speed_warning(p, times_real_time);
  if (!warning.empty()) ROS_WARN_STREAM(warning);
}

void report_run(const Parameters& p, const std::string& scheduler) {
  for (const std::string& warning : find_warnings(p)) ROS_WARN_STREAM(warning);
  ROS_INFO_STREAM("tip: " << describe_tip(p));
  ROS_INFO("eta = %g, %g samples a second of model time, %lu to a batch, scheduler: %s", to_eta(p.drag_velocity, p.si),
           p.sample_rate_hz, static_cast<unsigned long>(samples_per_batch(p)), scheduler.c_str());
}

template <class Response>
bool respond(Response& response, const std::string& fault, const char* if_done) {
  response.success = fault.empty();
  response.message = fault.empty() ? if_done : fault;
  return true;
}

class EmulatorNode {
 public:
  // Starts recording before anything else if that is asked for. Throws std::runtime_error if it cannot.
  EmulatorNode(ros::NodeHandle node, const Parameters& parameters)
      : parameters_(parameters),
        queue_(batches_in_queue(parameters, preallocated_batch(parameters)), preallocated_batch(parameters)),
        runner_(parameters, queue_),
        recorder_(recorder_settings(parameters), [this] { return runner_.submit(Request(Kind::snapshot)); }) {
    if (parameters.publish_clock) check_clock();
    if (parameters.record) {
      const Recorder::Reply reply = recorder_.start("");
      if (!reply.success) throw std::runtime_error("record = true: " + reply.message);
    }
    report_speed(parameters);
    live_server_.emplace(node, parameters, refusals_, [this](const Live& asked) {
      Request change(Kind::change);
      change.live = asked;
      Answer unused;
      return ask(change, unused);
    });
    publisher_.emplace(node, parameters, Publisher::Sources{queue_, recorder_, refusals_, [this](const Live& live) {
                                                              live_server_->applied(live);
                                                            }});
    if (parameters.publish_clock) check_clock();  // of one that began at the same time
    runner_.start();
    report_run(parameters, runner_.scheduler());
    advertise(node);
    publisher_->start(runner_.scheduler());  // last: whoever has a message finds the services
    spinner_.start();
    control_spinner_.start();
  }

  // In order: the last batch, all published, the bag closed, and only then the master, which may not answer.
  ~EmulatorNode() {
    closing_ = true;  // services that wait for an answer return, and can then be shut down
    runner_.stop();
    publisher_->stop();
    while (!recorder_.status().recording.empty()) recorder_.stop();  // a slow disk may take more than one wait
    begin_leaving();
    for (ros::Subscriber& subscriber : commands_) subscriber.shutdown();
    clients_timer_.stop();
    for (ros::ServiceServer& service : services_) service.shutdown();
  }

 private:
  void advertise(ros::NodeHandle& node) {
    control_node_.setCallbackQueue(&control_queue_);
    const auto hints = ros::TransportHints().tcpNoDelay();
    commands_ = {node.subscribe("drag_velocity", kCommandQueueSize, &EmulatorNode::on_drag_velocity, this, hints),
                 node.subscribe("rest_height", kCommandQueueSize, &EmulatorNode::on_rest_height, this, hints),
                 node.subscribe("load", kCommandQueueSize, &EmulatorNode::on_load, this, hints)};
    services_ = {node.advertiseService("pause", &EmulatorNode::on_pause, this),
                 node.advertiseService("reset", &EmulatorNode::on_reset, this),
                 control_node_.advertiseService("control", &EmulatorNode::on_control, this),
                 node.advertiseService("step", &EmulatorNode::on_step, this),
                 node.advertiseService("start_recording", &EmulatorNode::on_start_recording, this),
                 node.advertiseService("stop_recording", &EmulatorNode::on_stop_recording, this)};
    clients_timer_ = node.createWallTimer(ros::WallDuration(kClientsPeriod),
                                          [this](const auto&) { live_server_->update_clients(); });
  }

  void on_drag_velocity(const std_msgs::Float64& command) {
    Request request(Kind::command);
    request.cause = "drag_velocity";
    request.drag_velocity = command.data;
    submit_or_refuse(request, command.data, "m/s", find_drag_fault(command.data));
  }

  void on_rest_height(const std_msgs::Float64& command) {
    Request request(Kind::command);
    request.cause = "rest_height";
    request.rest_height = command.data;
    submit_or_refuse(request, command.data, "m", find_height_fault(request.rest_height));
  }

  void on_load(const std_msgs::Float64& command) {
    Request request(Kind::command);
    request.cause = "load";
    request.rest_height = 0.0 - command.data / spring_constant(parameters_.si);  // not -0
    submit_or_refuse(request, command.data, "N", find_height_fault(request.rest_height));
  }

  void submit_or_refuse(const Request& request, double given, const char* unit, const std::string& fault) {
    if (fault.empty() && runner_.submit(request)) return;
    std::ostringstream text;
    text << request.cause << " = " << number_text(given) << ' ' << unit << ": " << (fault.empty() ? kTooMany : fault);
    if (refusals_.add(fault.empty() ? Refusal::overload : Refusal::faulty_command, text.str())) {
      ROS_WARN_STREAM("refused: " << text.str());
    }
  }

  // The fault, or nothing.
  std::string find_drag_fault(double drag_velocity) const {
    const bool possible = std::abs(drag_velocity) <= parameters_.max_drag_velocity;  // false for NaN
    return possible ? ""
                    : "must be finite and within max_drag_velocity = " + number_text(parameters_.max_drag_velocity);
  }

  std::string find_height_fault(double rest_height) const {
    SiModel si = parameters_.si;
    si.rest_height_m = rest_height;
    const auto faults = find_faults(si);
    return faults.empty() ? "" : faults.front().reason;
  }

  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    const bool paused = request.data != 0;
    return respond(response, ask(paused ? Kind::pause : Kind::resume), paused ? "paused" : "running");
  }

  bool on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    return respond(response, ask(Kind::reset), "model time 0, initial state, start parameters, new epoch");
  }

  bool on_step(afm_emulator::Step::Request& request, afm_emulator::Step::Response& response) {
    std::string fault = find_step_fault(request.tau, request.impacts);
    Answer answer;
    if (fault.empty()) {
      Request step(Kind::step);
      step.tau = request.tau;
      step.impacts = request.impacts;
      fault = ask(step, answer);
    }
    response.time = to_message(answer.time);
    return respond(response, fault, request.impacts > 0 ? "impact reached" : "time reached");
  }

  bool on_control(afm_emulator::Control::Request& request, afm_emulator::Control::Response& response) {
    std::string fault = find_control_fault(request);
    Answer answer;
    if (fault.empty()) {
      Request period(Kind::control);
      period.cause = !std::isnan(request.drag_velocity) ? "drag_velocity"
                     : !std::isnan(request.rest_height) ? "rest_height"
                                                        : "";
      period.drag_velocity = request.drag_velocity;
      period.rest_height = request.rest_height;
      period.tau = request.duration / Units(parameters_.si).time();
      fault = ask(period, answer);
    } else {
      refusals_.add(Refusal::faulty_command, fault);
    }
    response = to_control(answer, parameters_.si);
    return respond(response, fault, "time reached");
  }

  std::string find_control_fault(const afm_emulator::Control::Request& request) const {
    const double v = request.drag_velocity, y = request.rest_height;
    const double most_tau = is_lockstep() ? kMaxStepTau : kMaxPeriodTau, most = most_tau * Units(parameters_.si).time();
    std::string fault = std::isnan(v) ? "" : find_drag_fault(v);
    if (!fault.empty()) return "drag_velocity = " + number_text(v) + " m/s: " + fault;
    fault = std::isnan(y) ? "" : find_height_fault(y);
    if (!fault.empty()) return "rest_height = " + number_text(y) + " m: " + fault;
    if (request.duration >= 0.0 && request.duration <= most) return {};
    return "duration = " + number_text(request.duration) + " s: must be between 0 and " + number_text(most) + " s, " +
           number_text(most_tau) + " tau";
  }

  // The recording begins with a snapshot that is taken for it.
  bool on_start_recording(afm_emulator::StartRecording::Request& request,
                          afm_emulator::StartRecording::Response& response) {
    const Recorder::Reply reply = recorder_.start(request.name);
    response.path = reply.path;
    if (!reply.success) return respond(response, reply.message, "");
    const std::string fault = ask(Kind::snapshot);
    if (!fault.empty()) recorder_.stop();
    return respond(response, fault.empty() ? "" : "ended again, as no snapshot was taken: " + fault,
                   reply.message.c_str());
  }

  // All that was emulated until now belongs to it.
  bool on_stop_recording(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    const std::string late = ask(Kind::flush);
    const Recorder::Reply reply = recorder_.stop();
    const std::string lacking = reply.success && !late.empty() ? "; what was emulated last is missing: " + late : "";
    response.success = reply.success && late.empty();
    response.message = reply.message + lacking;
    return true;
  }

  bool is_lockstep() const { return parameters_.pace == kLockstep; }

  // Waits until it was done and published. Returns why not, or nothing.
  std::string ask(Request request, Answer& answer) {
    // a control period in real time takes its time, and that of a pause
    const bool has_deadline = request.kind != Kind::control || request.tau == 0.0 || is_lockstep();
    request.reply = std::make_shared<std::promise<Answer>>();
    std::future<Answer> future = request.reply->get_future();
    if (!runner_.submit(request)) {
      if (request.cause[0] != '\0') refusals_.add(Refusal::overload, std::string("control: ") + kTooMany);
      return kTooMany;
    }
    const auto begin = std::chrono::steady_clock::now();
    while (is_lockstep() && future.wait_for(std::chrono::seconds(0)) != std::future_status::ready &&
           std::chrono::steady_clock::now() - begin < kSpin) {
      std::this_thread::yield();
    }
    while (future.wait_for(kClosingPoll) != std::future_status::ready) {
      if (closing_ || ros::isShuttingDown()) return "the emulator is shutting down";
      if (has_deadline && std::chrono::steady_clock::now() - begin > kAnswerDeadline) {
        return "not done and published in time; it may still be";
      }
    }
    answer = future.get();
    const std::string fault = answer.fault;
    if (fault != kWallTimeRanOut && fault != kModelTimeRanOut) return fault;
    const double tau = static_cast<double>(answer.time.tau) + answer.time.phase;
    return fault + " after " + std::to_string(answer.impacts) + " impacts, at model time " + number_text(tau) + " tau" +
           (request.cause[0] != '\0' ? "; the command of the same call holds" : "");
  }

  std::string ask(Kind kind) {
    Answer unused;
    return ask(Request(kind), unused);
  }

  const Parameters parameters_;
  Refusals refusals_;
  BatchQueue queue_;
  Runner runner_;
  Recorder recorder_;
  std::atomic<bool> closing_{false};
  std::optional<LiveServer> live_server_;  // these advertise, so they are made after all that can fail
  std::optional<Publisher> publisher_;
  ros::CallbackQueue control_queue_;
  ros::NodeHandle control_node_{"~"};
  std::vector<ros::Subscriber> commands_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer clients_timer_;
  // the last to begin and the first to end: roscpp aborts where a callback publishes on a topic that is withdrawn
  ros::AsyncSpinner spinner_{kSpinnerThreads}, control_spinner_{kControlThreads, &control_queue_};
};

constexpr char kHelp[] =
    "The AFM tip as a ROS node. It needs a master, takes private parameters alone (_drag_velocity:=5.0e-6), and is "
    "best\n"
    "started by: roslaunch afm_emulator emulator.launch\n"
    "config/emulator.yaml describes every parameter, docs/interface.md the topics and services.\n";

constexpr int kLargeBuffer =
    256 * 1024;  // [bytes] more than a message of 10 ms takes, at up to a million samples a second

// glibc gives each thread a heap of its own, and each keeps back freed memory: 10 MB after some recordings. We allow
// one heap. The running thread need not wait for it, as it allocates nothing. Large buffers, as of bags and of
// messages, come from the system each time. Otherwise glibc raises its threshold when the first is freed, and keeps all
// of them.
void keep_memory_flat() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargeBuffer);
}

void run(const ros::NodeHandle& handle, const Parameters& parameters) {
  const EmulatorNode node(handle, parameters);
  now_running();
  while (ros::ok() && !is_asked_to_end()) std::this_thread::sleep_for(kShutdownPoll);
}

}  // namespace
}  // namespace afm::node

int main(int argc, char** argv) {
  using namespace afm::node;  // it is the program
  if (argc > 1 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
    std::cout << kHelp;
    return 0;
  }
  keep_memory_flat();
  await_signals();
  std::setlocale(LC_CTYPE, "");  // paths with other letters than ASCII stay readable in the log
  try {
    ros::init(argc, argv, "afm", ros::init_options::NoSigintHandler);
  } catch (const ros::InvalidNameException& fault) {
    std::cerr << "emulator_node: the name of the node: " << fault.what() << "\n";
    return 1;
  } catch (const std::exception& fault) {  // it can make no folder for its logs
    std::cerr << "emulator_node: " << fault.what() << "\n";
    return 1;
  }
  const ros::NodeHandle handle("~");  // roscpp shuts down with its last handle
  Faults faults;
  const auto parameters = load_parameters(handle, faults);
  if (!faults.empty()) {
    ROS_FATAL_STREAM("faulty parameters:\n" << describe(faults));
    return 1;
  }
  try {
    run(handle, parameters);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  ros::shutdown();
  has_left();
  return 0;
}
