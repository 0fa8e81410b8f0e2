// What messages say of the figures of the core.
#include "node/publisher/messages.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace afm::node {
namespace {

// A field that is forgotten stays 0 for ever, in a replay too.
TEST(Messages, EveryNumberOfFrictionIsFilled) {
  Batch batch;
  batch.begin = {1, 0.25};
  batch.end = {2, 0.5};
  batch.first_impact = 3;
  batch.impact_limit = 4;
  batch.eta = 2.0;
  FrictionEstimate& f = batch.friction;
  for (double* number : {&f.force, &f.force_std_error, &f.K_f, &f.K_f_std_error, &f.energy_loss, &f.window_force,
                         &f.window_K_f, &f.window_K_f_std_error, &f.mean_lateral_force, &f.mean_lateral_force_std_error,
                         &f.K_f_work, &f.K_f_work_std_error, &f.mean_normal_force, &f.heat_to_bath}) {
    *number = 1.5;
  }
  f.impact_count = 5;
  Live live;
  live.drag_velocity = 1e-6;
  std::stringstream text;
  text << to_friction(batch, live, Units(live.si), {ros::Time(6, 7), 8});
  int numbers = 0;
  for (std::string line; std::getline(text, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos || line.find("seq") != std::string::npos) continue;  // the publisher's
    ++numbers;
    EXPECT_NE(line.substr(colon + 2), "0") << line;
  }
  EXPECT_GT(numbers, 25);
}

}  // namespace
}  // namespace afm::node
