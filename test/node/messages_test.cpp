// What messages say of the figures of the core.
#include "node/publisher/messages.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>

namespace afm::node {
namespace {

// Each estimate is a prime, and each unit is made of others. A field that is forgotten stays 0, in a replay too.
TEST(Messages, EveryFigureOfFrictionIsItsOwnInItsOwnUnit) {
  constexpr double kA = 2.0, kTau = 3.0, kMass = 5.0;
  Batch batch;
  batch.begin = {1, 0.25};
  batch.end = {2, 0.5};
  batch.first_impact = 3;
  batch.impact_limit = 4;
  batch.eta = 67.0;
  FrictionEstimate& f = batch.friction;
  f.force = 7.0, f.force_std_error = 11.0, f.K_f = 13.0, f.K_f_std_error = 17.0, f.energy_loss = 19.0;
  f.window_force = 23.0, f.window_K_f = 29.0, f.window_K_f_std_error = 31.0, f.mean_lateral_force = 37.0;
  f.mean_lateral_force_std_error = 41.0, f.K_f_work = 43.0, f.K_f_work_std_error = 47.0, f.mean_normal_force = 53.0;
  f.heat_to_bath = 59.0, f.impact_count = 61;
  Live live;
  live.drag_velocity = 71.0;
  SiModel si;
  si.lattice_spacing_m = kA, si.omega_v_rad_per_s = kTwoPi / kTau, si.tip_mass_kg = kMass;
  const afm_emulator::Friction m = to_friction(batch, live, Units(si), {ros::Time(6, 7), 8});
  const double force = kMass * kA / (kTau * kTau), friction = kMass / kTau, energy = force * kA;
  for (const auto& [field, expected] : {std::pair(m.eta, 67.0),
                                        {m.drag_velocity, 71.0},
                                        {m.force, 7.0 * force},
                                        {m.force_std_error, 11.0 * force},
                                        {m.k_f, 13.0 * friction},
                                        {m.k_f_std_error, 17.0 * friction},
                                        {m.k_f_natural, 13.0},
                                        {m.energy_loss, 19.0 * energy},
                                        {m.window_force, 23.0 * force},
                                        {m.window_k_f, 29.0 * friction},
                                        {m.window_k_f_std_error, 31.0 * friction},
                                        {m.window_k_f_natural, 29.0},
                                        {m.mean_lateral_force, 37.0 * force},
                                        {m.mean_lateral_force_std_error, 41.0 * force},
                                        {m.k_f_work, 43.0 * friction},
                                        {m.k_f_work_std_error, 47.0 * friction},
                                        {m.k_f_work_natural, 43.0},
                                        {m.mean_normal_force, 53.0 * force},
                                        {m.heat_to_bath, 59.0 * energy}}) {
    EXPECT_NEAR(field / expected, 1.0, 1e-14) << expected;
  }
  EXPECT_EQ(m.impact_count, 61u);
  std::stringstream text;
  text << m;
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
