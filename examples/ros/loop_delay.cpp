// Measures how long a controller waits: from publishing a drag velocity until ~applied says that it holds, and until
// the first batch that was moved by it arrives. Prints one row of CSV.
// Parameters: emulator; commands, how many; batch_rate_hz is asked of the emulator's configuration.
#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The command under way.
struct Command {
  double velocity = 0.0;
  bool applied = false, seen = false;
  afm_emulator::ModelTime time;  // from which it holds
  double applied_s = 0.0, seen_s = 0.0;
};

bool is_before(const afm_emulator::ModelTime& a, const afm_emulator::ModelTime& b) {
  return a.tau != b.tau ? a.tau < b.tau : a.phase < b.phase;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "loop_delay");
  ros::NodeHandle node, own("~");
  const auto emulator = own.param<std::string>("emulator", "/afm");
  const int count = own.param("commands", 1000);
  constexpr double kPatience = 5.0;  // [s] a command that takes longer is reported

  Command now;
  afm_emulator::ModelTime latest_batch;  // begins at
  ros::WallTime published;
  double batch_rate = 0.0;
  const auto elapsed = [&] { return (ros::WallTime::now() - published).toSec(); };
  const auto on_configuration = [&](const afm_emulator::Configuration::ConstPtr& m) { batch_rate = m->batch_rate_hz; };
  // the two topics have a connection each: either may be first
  const auto look = [&] {
    if (!now.applied || now.seen || is_before(latest_batch, now.time)) return;
    now.seen = true;
    now.seen_s = elapsed();
  };
  const auto on_applied = [&](const afm_emulator::Applied::ConstPtr& m) {
    if (now.applied || m->drag_velocity != now.velocity) return;
    now.applied = true;
    now.applied_s = elapsed();
    now.time = m->time;
    look();
  };
  const auto on_batch = [&](const afm_emulator::Deflection::ConstPtr& m) {
    latest_batch = m->time;
    look();
  };
  const auto fast = ros::TransportHints().tcpNoDelay();
  const ros::Subscriber subscribers[] = {
      node.subscribe<afm_emulator::Configuration>(emulator + "/configuration", 10, on_configuration),
      node.subscribe<afm_emulator::Applied>(emulator + "/applied", 100, on_applied, {}, fast),
      node.subscribe<afm_emulator::Deflection>(emulator + "/deflection", 100, on_batch, {}, fast)};
  const ros::Publisher drag = node.advertise<std_msgs::Float64>(emulator + "/drag_velocity", 10);
  const auto spin_until = [](double seconds, const auto& done) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && !done() && ros::WallTime::now() < end)
      ros::getGlobalCallbackQueue()->callOne(ros::WallDuration(0.001));
    return done();
  };
  while (ros::ok() && !(batch_rate > 0.0 && drag.getNumSubscribers() > 0)) spin_until(0.1, [] { return false; });

  std::vector<double> applied_ms, seen_ms;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.0, 2.0);  // batches: commands fall on every phase of a batch
  for (int i = 0; i < count && ros::ok(); ++i) {
    spin_until(pause(random) / batch_rate, [] { return false; });
    now = Command();
    now.velocity = (i % 2 == 0 ? 2.0 : 2.01) * 3.3104228e-6;
    std_msgs::Float64 message;
    message.data = now.velocity;
    published = ros::WallTime::now();
    drag.publish(message);
    if (!spin_until(kPatience, [&] { return now.seen; })) continue;
    applied_ms.push_back(1e3 * now.applied_s);
    seen_ms.push_back(1e3 * now.seen_s);
  }
  if (seen_ms.empty()) {
    std::fprintf(stderr, "loop_delay: no command was seen to take effect\n");
    return 1;
  }
  std::printf(
      "batch rate / Hz,commands,lost,applied: median / ms,applied: p99 / ms,in a batch: median / ms,in a batch: p99 / "
      "ms\n");
  std::printf("%g,%zu,%zu,%.2f,%.2f,%.2f,%.2f\n", batch_rate, seen_ms.size(),
              static_cast<std::size_t>(count) - seen_ms.size(), quantile(applied_ms, 0.5), quantile(applied_ms, 0.99),
              quantile(seen_ms, 0.5), quantile(seen_ms, 0.99));
  return 0;
}
