// Measures how long a controller waits: from commanding a drag velocity until ~applied says that it holds. Prints one
// row of CSV. Parameters: emulator; commands, how many.
#include <afm_emulator/client.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>

int main(int argc, char** argv) try {
  ros::init(argc, argv, "loop_delay");
  ros::NodeHandle own("~");
  const double commands = afm_emulator::number_parameter(own, "commands", 1000.0);
  if (!(commands >= 1.0 && commands <= 1e9)) {
    throw std::invalid_argument("commands = " + std::to_string(commands) + ": must be between 1 and 1e9");
  }
  const auto count = static_cast<std::size_t>(commands);
  afm_emulator::Client tip(own.param<std::string>("emulator", "afm"));
  const double batch_rate = tip.configuration().batch_rate_hz;
  std::vector<double> waits_ms;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.0, 2.0);  // batches: commands fall on every phase of a batch
  while (waits_ms.size() < count) {
    ros::WallDuration(pause(random) / batch_rate).sleep();
    const ros::WallTime commanded = ros::WallTime::now();
    tip.command_and_wait((waits_ms.size() % 2 == 0 ? 2.0 : 2.01) * 3.3104228e-6);
    waits_ms.push_back(1e3 * (ros::WallTime::now() - commanded).toSec());
  }
  std::sort(waits_ms.begin(), waits_ms.end());
  std::printf("batch rate / Hz,commands,median / ms,p99 / ms\n%g,%zu,%.2f,%.2f\n", batch_rate, count,
              waits_ms[count / 2], waits_ms[count * 99 / 100]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "loop_delay: %s\n", error.what());
  return 1;
}
