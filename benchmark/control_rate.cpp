// How many control periods a second the C++ client makes in lockstep. Prints the number.
// usage: control_rate _duration:=0.01 _periods:=2000
#include <afm_emulator/client.h>

#include <cstdio>

int main(int argc, char** argv) {
  ros::init(argc, argv, "control_rate");
  ros::NodeHandle own("~");
  const double duration = own.param("duration", 0.01);
  const int periods = own.param("periods", 2000);
  afm_emulator::Client tip("afm");
  for (int i = 0; i < periods / 4; ++i) tip.control(duration);  // while what starts with it takes its part
  const ros::WallTime begin = ros::WallTime::now();
  for (int i = 0; i < periods; ++i) tip.control(duration);
  std::printf("%.6g\n", periods / (ros::WallTime::now() - begin).toSec());
  return 0;
}
