#include "afm/reflection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/models.h"
#include "trials/quad.h"

namespace afm {
namespace {

GapJet<double> on_surface(const Model& model, const FlightState<double>& state, double g1) {
  const SurfaceJet<double> surface = surface_jet(model.H, state.phase);
  return {0.0, g1, 0.0, 0.0, state, surface.h, surface.h1};
}

// An incident state in double, and its velocities in quad.
struct Incident {
  double eta;
  GapJet<double> jet;
  Quad slope, u, w, normal, tangential;
};

class Incidents {
 public:
  explicit Incidents(unsigned seed) : random_(seed) {}

  Incident next(const Model& model) {
    Incident i;
    i.eta = within(-9.0, 9.0);
    const FlightState<double> state{within(-2.0, 2.0), within(-0.1, 0.1), within(-5.0, 5.0), 0.0, 0.0};
    i.jet = on_surface(model, state, -std::pow(10.0, within(-8.0, 1.0)));
    i.slope = surface_jet(Quad(model.H), Quad(state.phase)).h1;
    i.u = Quad(i.eta) + state.U;
    i.w = i.slope * i.u + i.jet.g1;
    const Quad n = sqrt(1 + i.slope * i.slope);
    i.normal = i.jet.g1 / n;
    i.tangential = (i.u + i.slope * i.w) / n;
    return i;
  }
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937_64 random_;
};

const Model kModels[] = {model_with(0.7, 0.05), model_with(0.7, 0.0),  model_with(0.0, 0.05),
                         model_with(0.0, 0.0),  model_with(1.0, 0.05), model_with(0.3, 3.0)};

Quad exact_restitution(const Model& m, const Quad& speed) {
  return speed >= m.v_c ? Quad(m.gamma) : 1 - (1 - Quad(m.gamma)) * speed / m.v_c;
}

// check(model, incidence, reflection) for 2000 incidences on each model.
template <class Check>
void for_each_reflection(unsigned seed, const Check& check) {
  for (const Model& model : kModels) {
    Incidents incidents(seed);
    for (int k = 0; k < 2000 && !testing::Test::HasFailure(); ++k) {
      const Incident i = incidents.next(model);
      check(model, i, reflect(model, i.eta, i.jet));
    }
  }
}

TEST(Reflection, KeepsTangentialVelocity) {
  for_each_reflection(1, [](const Model&, const Incident& i, const Reflection& r) {
    const Quad w = i.slope * r.after.u + r.after.g1, n = sqrt(1 + i.slope * i.slope);
    const double near_enough = 1e-15 * (1.0 + static_cast<double>(abs(i.u) + abs(i.w)));
    ASSERT_LE(static_cast<double>(abs((r.after.u + i.slope * w) / n - i.tangential)), near_enough);
    ASSERT_LE(static_cast<double>(abs(r.tangential_velocity - i.tangential)), near_enough);
  });
}

TEST(Reflection, TurnsTheNormalVelocityRoundTimesTheRestitution) {
  for_each_reflection(2, [](const Model& model, const Incident& i, const Reflection& r) {
    const Quad speed = -i.normal, gamma_eff = exact_restitution(model, speed);
    ASSERT_LE(relative_error(r.normal_speed, speed), 1e-15);
    ASSERT_LE(static_cast<double>(abs(r.after.g1 + gamma_eff * i.jet.g1)), 1e-15 * std::abs(i.jet.g1));
  });
}

TEST(Reflection, TheEnergyLostIsTheKineticEnergyThatIsMissing) {
  for_each_reflection(3, [](const Model& model, const Incident& i, const Reflection& r) {
    // exactly reflected, Eq. 11: the difference of doubles would drown in rounding
    const Quad gamma_eff = exact_restitution(model, -i.normal), n = sqrt(1 + i.slope * i.slope);
    const Quad u = i.u + (1 + gamma_eff) * i.normal * i.slope / n, w = i.w - (1 + gamma_eff) * i.normal / n;
    const Quad lost = (i.u * i.u + i.w * i.w - u * u - w * w) / 2;
    const double rounding = 1e-31 * static_cast<double>(i.u * i.u + i.w * i.w);
    ASSERT_LE(static_cast<double>(abs(r.energy_loss - lost)), 2e-15 * static_cast<double>(lost) + rounding);
    ASSERT_LE(static_cast<double>(abs(r.after.u - u)),
              1e-15 * (1.0 + std::abs(static_cast<double>(i.u - u)) + static_cast<double>(abs(i.u))));
  });
}

TEST(Reflection, WithGammaOneNothingIsLostAndWithNoughtTheNormalVelocityIsGone) {
  Incidents incidents(4);
  for (int k = 0; k < 1000; ++k) {
    const Incident i = incidents.next(Model());
    const Reflection elastic = reflect(model_with(1.0, 0.05), i.eta, i.jet);
    ASSERT_EQ(elastic.energy_loss, 0.0);
    ASSERT_EQ(elastic.after.g1, -i.jet.g1);
    const Reflection dead = reflect(model_with(0.0, 0.0), i.eta, i.jet);
    ASSERT_EQ(dead.after.g1, 0.0);
    ASSERT_LE(relative_error(dead.energy_loss, i.normal * i.normal / 2), 1e-15);
  }
}

TEST(Reflection, OfATouchWithoutSpeedChangesNothing) {
  const FlightState<double> state{0.1, 0.01, 0.3, 0.0, 0.0};
  for (const Model& model : kModels) {
    const Reflection r = reflect(model, 3.4, on_surface(model, state, 0.0));
    EXPECT_EQ(r.after.u, 3.4 + 0.3);
    EXPECT_EQ(r.after.g1, 0.0);
    EXPECT_EQ(r.energy_loss, 0.0);
    EXPECT_EQ(r.normal_speed, 0.0);
  }
}

}  // namespace
}  // namespace afm
