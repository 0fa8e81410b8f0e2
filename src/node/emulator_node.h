// The node: wires between ROS and the threads that step, publish and record.
#pragma once

#include <afm_emulator/StartRecording.h>
#include <afm_emulator/Step.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <std_msgs/Float64.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <optional>
#include <string>
#include <vector>

#include "node/wire/broadcaster.h"
#include "control.h"
#include "node/recording/disk_space.h"
#include "node/stepping/hand_over.h"
#include "node/wire/master_watch.h"
#include "node/parameters/parameters.h"
#include "node/parameters/reconfigure_server.h"
#include "node/recording/recorder.h"
#include "refusals.h"
#include "node/stepping/sample_demand.h"
#include "node/stepping/stepper.h"

namespace afm::node {

class EmulatorNode {
 public:
  // Starts recording before anything else if that is asked for. Throws std::runtime_error if it cannot.
  EmulatorNode(ros::NodeHandle node, const Parameters& parameters);
  ~EmulatorNode();  // in order: no more commands, the last batch, all published, the bag closed

 private:
  void accept_commands(ros::NodeHandle& node);
  void watch_master();
  void on_drag_velocity(const std_msgs::Float64& command);
  void on_rest_height(const std_msgs::Float64& command);
  void obey(Request::Kind kind, const char* name, const char* unit, double value, const std::string& fault);
  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_step(afm_emulator::Step::Request& request, afm_emulator::Step::Response& response);
  Recorder::Reply start_recording(const std::string& name);
  bool on_start_recording(afm_emulator::StartRecording::Request& request,
                          afm_emulator::StartRecording::Response& response);
  bool on_stop_recording(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  const Parameters parameters_;
  Refusals refusals_;
  DiskSpace disk_;
  Recorder recorder_;
  HandOver hand_over_;
  SampleDemand demand_;
  Stepper stepper_;
  Control control_;
  std::optional<ReconfigureServer> reconfigure_;  // these advertise, so they are made after all that can fail
  std::optional<Broadcaster> broadcaster_;
  ros::Subscriber drag_velocity_, rest_height_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer disk_look_;
  std::optional<MasterWatch> master_watch_;
};

}  // namespace afm::node
