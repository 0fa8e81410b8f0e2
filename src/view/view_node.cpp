// view_node: draws an emulator, live or replayed, as markers for rviz (~markers), thirty pictures a second.
// Parameters: ~emulator, its name (default: afm, beside this node); ~cells, how much of the surface is seen.
#include <afm_emulator/client.h>
#include <ros/ros.h>

#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "node/publisher/topics.h"
#include "picture.h"

namespace {

using namespace afm;
using afm::view::RunView;

constexpr unsigned kBatchesKept = 1000;  // a step in slow motion makes hundreds at once, and a gap cuts the path off

template <class Message>
ros::Subscriber subscribe(ros::NodeHandle& emulator, const char* topic, unsigned queue_size, RunView& run) {
  const boost::function<void(const Message&)> take = [&run](const Message& message) { run.take(message); };
  return emulator.subscribe<Message>(topic, queue_size, take, {}, ros::TransportHints().tcpNoDelay());
}

// Subscribes to the emulator while it exists, and keeps what it receives.
class Looking {
 public:
  Looking(ros::NodeHandle& emulator, double cells)
      : picture_(cells),
        subscribers_{
            subscribe<afm_emulator::Configuration>(emulator, node::kConfigurationTopic, node::kLatchedQueueSize, run_),
            subscribe<afm_emulator::Applied>(emulator, node::kAppliedTopic, node::kCommandQueueSize, run_),
            subscribe<afm_emulator::Deflection>(emulator, node::kDeflectionTopic, kBatchesKept, run_),
            subscribe<afm_emulator::ImpactArray>(emulator, node::kImpactsTopic, kBatchesKept, run_),
            subscribe<afm_emulator::Friction>(emulator, node::kFrictionTopic, kBatchesKept, run_)} {}

  visualization_msgs::MarkerArray draw() { return picture_.draw(run_, ros::Time(ros::WallTime::now().toSec())); }

 private:
  RunView run_;
  view::Picture picture_;
  std::vector<ros::Subscriber> subscribers_;
};

int run(int argc, char** argv) {
  ros::init(argc, argv, "afm_view");
  ros::NodeHandle handle("~");
  const double cells = afm_emulator::number_parameter(handle, "cells", 6.0);
  if (!(cells >= 1.0 && cells <= 100.0)) {
    ROS_FATAL("cells = %g: between 1 and 100 cells of the surface can be shown", cells);
    return 1;
  }
  const auto name = handle.param<std::string>("emulator", "afm");
  std::string fault;
  if (!ros::names::validate(name, fault)) throw ros::InvalidNameException(fault);  // a handle would leak memory
  ros::NodeHandle emulator(name);
  const auto publisher = handle.advertise<visualization_msgs::MarkerArray>("markers", 2);
  std::optional<Looking> looking;  // while somebody looks: otherwise nothing is listened to, and nothing is kept
  const auto draw = [&](const ros::WallTimerEvent&) {
    if (publisher.getNumSubscribers() == 0) return looking.reset();
    if (!looking) looking.emplace(emulator, cells);
    publisher.publish(looking->draw());
  };
  // of wall time: a replay may come without a clock
  const ros::WallTimer timer = handle.createWallTimer(ros::WallDuration(1.0 / view::kPictureRate), draw);
  ros::spin();  // one thread: messages and pictures take turns
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& fault) {  // such as a name that cannot be, of the node or of the emulator
    std::cerr << "view_node: " << fault.what() << "\n";
    return 1;
  }
}
