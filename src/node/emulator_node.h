// The node: wires between ROS and the threads that run, publish and record.
#pragma once

#include <afm_emulator/Control.h>
#include <afm_emulator/StartRecording.h>
#include <afm_emulator/Step.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <std_msgs/Float64.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "live_server.h"
#include "node/params/parameters.h"
#include "node/publisher/publisher.h"
#include "node/publisher/refusals.h"
#include "node/recorder/recorder.h"
#include "node/runner/batch_queue.h"
#include "node/runner/runner.h"

namespace afm::node {

class EmulatorNode {
 public:
  // Starts recording before anything else if that is asked for. Throws std::runtime_error if it cannot.
  EmulatorNode(ros::NodeHandle node, const Parameters& parameters);
  ~EmulatorNode();  // in order: no more commands, the last batch, all published, the bag closed

 private:
  void advertise(ros::NodeHandle& node);
  void on_drag_velocity(const std_msgs::Float64& command);
  void on_rest_height(const std_msgs::Float64& command);
  void on_load(const std_msgs::Float64& command);
  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_step(afm_emulator::Step::Request& request, afm_emulator::Step::Response& response);
  bool on_control(afm_emulator::Control::Request& request, afm_emulator::Control::Response& response);
  bool on_start_recording(afm_emulator::StartRecording::Request& request,
                          afm_emulator::StartRecording::Response& response);
  bool on_stop_recording(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  // Each returns what is wrong, or nothing.
  std::string find_drag_fault(double drag_velocity) const;
  std::string find_height_fault(double rest_height) const;
  std::string find_control_fault(const afm_emulator::Control::Request& request) const;
  void submit_or_refuse(const Request& request, double given, const char* unit, const std::string& fault);
  std::string ask(Request request, Answer& answer);  // waits until it was done and published
  std::string ask(Request::Kind kind);

  const Parameters parameters_;
  Refusals refusals_;
  std::atomic<std::int64_t> free_bytes_{-1};  // on the disk that is recorded to; negative: unknown
  BatchQueue queue_;
  Runner runner_;
  Recorder recorder_;
  std::atomic<bool> closing_{false};
  std::optional<LiveServer> live_server_;  // these advertise, so they are made after all that can fail
  std::optional<Publisher> publisher_;
  std::vector<ros::Subscriber> commands_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer disk_timer_, clients_timer_;
};

}  // namespace afm::node
