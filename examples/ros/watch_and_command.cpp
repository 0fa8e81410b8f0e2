// A subscriber and commander in C++: checks that no sample and no impact is lost, commands drag velocities in turn, and
// prints the friction of each.
// usage: watch_and_command [DRAG_VELOCITY...]     in m/s; without one it watches until Ctrl-C
// Parameters: emulator; hold_s of wall time for each velocity. Exit code 1 if something was lost, 2 for what is no
// number.
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

// Counts what is missing in a running index, which begins again with every epoch.
class Gaps {
 public:
  void add(std::uint32_t epoch, std::uint64_t first, std::size_t count) {
    if (begun_ && epoch == epoch_ && first > next_) lost_ += first - next_;  // less: it was started again
    begun_ = true;
    epoch_ = epoch;
    next_ = first + count;
    seen_ += count;
  }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t seen() const { return seen_; }

 private:
  bool begun_ = false;
  std::uint32_t epoch_ = 0;
  std::uint64_t next_ = 0, seen_ = 0, lost_ = 0;
};

double number(const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end != text && *end == '\0') return value;
  std::fprintf(stderr, "watch_and_command: '%s' is no drag velocity\n", text);
  std::exit(2);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "watch_and_command");
  std::vector<double> velocities;
  for (int i = 1; i < argc; ++i) velocities.push_back(number(argv[i]));
  ros::NodeHandle node, own("~");
  const auto emulator = own.param<std::string>("emulator", "/afm");
  const double hold = own.param("hold_s", 2.0);

  Gaps samples, impacts;
  afm_emulator::Friction friction;
  const auto fast = ros::TransportHints().tcpNoDelay();  // without it a message at 1 kHz may wait 40 ms
  const auto on_deflection = [&](const afm_emulator::Deflection::ConstPtr& m) {
    samples.add(m->epoch, m->first_sample, m->vertical.size());
  };
  const auto on_impacts = [&](const afm_emulator::ImpactArray::ConstPtr& m) {
    impacts.add(m->epoch, m->first_index, m->impacts.size());
  };
  const auto on_friction = [&](const afm_emulator::Friction::ConstPtr& m) { friction = *m; };
  const ros::Subscriber subscribers[] = {
      node.subscribe<afm_emulator::Deflection>(emulator + "/deflection", 100, on_deflection, {}, fast),
      node.subscribe<afm_emulator::ImpactArray>(emulator + "/impacts", 100, on_impacts, {}, fast),
      node.subscribe<afm_emulator::Friction>(emulator + "/friction", 100, on_friction, {}, fast)};
  const ros::Publisher drag = node.advertise<std_msgs::Float64>(emulator + "/drag_velocity", 10);

  const auto spin_for = [](double seconds) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && ros::WallTime::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  };
  // until the emulator is there, and listens
  while (ros::ok() && (samples.seen() == 0 || drag.getNumSubscribers() == 0)) spin_for(0.1);
  for (const double velocity : velocities) {
    std_msgs::Float64 command;
    command.data = velocity;
    drag.publish(command);
    spin_for(hold);
    ROS_INFO("%.3f um/s: eta %.3f, K_f from the work of the drag (%.4g +- %.2g) kg/s, mean lateral force %.1f pN",
             1e6 * friction.drag_velocity, friction.eta, friction.k_f_work, friction.k_f_work_std_error,
             1e12 * friction.mean_lateral_force);
  }
  if (velocities.empty()) ros::spin();
  std::printf("%lu samples and %lu impacts; lost: %lu and %lu\n", samples.seen(), impacts.seen(), samples.lost(),
              impacts.lost());
  return samples.lost() + impacts.lost() > 0 ? 1 : 0;
}
