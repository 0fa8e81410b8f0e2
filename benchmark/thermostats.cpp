// The mean square deflection of a heated tip at rest against its exact value: exact motion between kicks, and two
// integrators with a penalty spring in the place of the surface. Each gets the same time. CSV.
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "afm/surface.h"
#include "afm/tip.h"
#include "common/command_line.h"
#include "core/run/batch_means.h"
#include "trials/boltzmann.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kHolder = 0.1;    // xc [a]: on a slope of the surface
constexpr double kInterval = 0.1;  // between samples [tau]
constexpr std::size_t kBatch = 200;

constexpr double kTheta = 0.926;                                           // kT at 300 K [m_tip a^2/tau^2]
constexpr double kQuality = 2.0;                                           // of both springs
constexpr double kKicks[] = {0.5, 2.0, 8.0, 29.034};                       // per tau
constexpr double kStiffness[] = {1.0, 0.25};                               // of the penalty spring, omega_p h
constexpr double kSteps[] = {0.01, 0.005, 0.002, 0.001, 0.0005, 0.00025};  // of the integrators [tau]

// Langevin dynamics of both springs: BAOAB, and Euler-Maruyama in its semi-implicit form (the explicit one diverges on
// the penalty spring). `stiffness`: omega_p h of the penalty spring, a contact takes pi / (omega_p h) steps.
class Penalty {
 public:
  Penalty(double h, double stiffness)
      : h_(h), steps_(std::lround(kInterval / h)), k_(stiffness * stiffness / (h * h)) {}

  double baoab() {
    const double c_v = std::exp(-m_.omega_v * h_ / kQuality), c_h = std::exp(-m_.omega_h * h_ / kQuality);
    const double s_v = std::sqrt((1.0 - c_v * c_v) * kTheta), s_h = std::sqrt((1.0 - c_h * c_h) * kTheta);
    for (long i = 0; i < steps_; ++i) {
      kick(0.5 * h_);
      drift(0.5 * h_);
      u_ = c_h * u_ + s_h * normal_(random_);
      w_ = c_v * w_ + s_v * normal_(random_);
      drift(0.5 * h_);
      find_force();
      kick(0.5 * h_);
    }
    return Y_;
  }

  double euler_maruyama() {
    const double c_v = 1.0 - m_.omega_v * h_ / kQuality, c_h = 1.0 - m_.omega_h * h_ / kQuality;
    const double s_v = std::sqrt(2.0 * (1.0 - c_v) * kTheta), s_h = std::sqrt(2.0 * (1.0 - c_h) * kTheta);
    for (long i = 0; i < steps_; ++i) {
      find_force();
      u_ = c_h * u_ + s_h * normal_(random_);
      w_ = c_v * w_ + s_v * normal_(random_);
      kick(h_);
      drift(h_);
    }
    return Y_;
  }

 private:
  void drift(double h) {
    X_ += h * u_;
    Y_ += h * w_;
  }
  void kick(double h) {
    u_ += h * force_X_;
    w_ += h * force_Y_;
  }
  void find_force() {
    const afm::SurfaceJet<double> surface = afm::surface_jet(m_.H, kHolder + X_);
    const double gap = Y_ - surface.h, push = gap < 0.0 ? -k_ * gap : 0.0;
    force_X_ = -m_.omega_h * m_.omega_h * X_ - surface.h1 * push;
    force_Y_ = -m_.omega_v * m_.omega_v * Y_ + push;
  }

  afm::SpringConstants<double> m_{afm::Model{}};
  double h_;
  long steps_;
  double k_;
  double X_ = 0.0, Y_ = 0.2, u_ = 0.0, w_ = 0.0, force_X_ = 0.0, force_Y_ = 0.0;
  boost::random::mt19937_64 random_{1};
  boost::random::normal_distribution<double> normal_;
};

// For `at_least` [s]. `next` brings the tip one interval on and gives y - y0.
void measure(const char* method, double knob, double stiffness, double at_least, const std::function<double()>& next) {
  const double exact = afm::Boltzmann(kTheta, kHolder).mean_Y2();
  std::vector<double> batches;
  for (std::size_t i = 0; i < kBatch; ++i) next();
  const auto begin = Clock::now();
  double seconds = 0.0, sum = 0.0;
  while (seconds < at_least || batches.size() < afm::detail::kMinBatches) {
    double batch = 0.0;
    for (std::size_t i = 0; i < kBatch; ++i) {
      const double Y = next();
      batch += Y * Y / kBatch;
    }
    batches.push_back(batch);
    sum += batch;
    seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  }
  const double n = static_cast<double>(batches.size());
  std::printf("%s,%g,%g,%.4g,%.2g,%.4g\n", method, knob, stiffness, sum / n / exact - 1.0,
              afm::detail::mean_error(batches).std_error / exact, seconds / (n * kBatch * kInterval) * 1e6);
  std::fflush(stdout);
}

void measure_kicks(double seconds, double kicks_per_tau) {
  afm::Model model;
  model.gamma = 1.0;
  afm::Tip tip(model, 0.0, afm::FreeState{kHolder, 0.0, 0.2, 0.0, 0.0});
  afm::Bath bath;
  bath.temperature = kTheta;
  bath.quality_factor = kQuality;
  bath.kicks_per_tau = kicks_per_tau;
  tip.set_bath(bath);
  afm::ModelTime time;
  measure("exact", kicks_per_tau, HUGE_VAL, seconds, [&] {
    time = time + kInterval;
    while (tip.advance(time) != afm::Outcome::time_limit) continue;
    return tip.deflection(time).vertical;
  });
}

void measure_penalty(double seconds, double h, double stiffness) {
  Penalty baoab(h, stiffness), euler(h, stiffness);
  measure("baoab_penalty", h, stiffness, seconds, [&] { return baoab.baoab(); });
  measure("euler_maruyama_penalty", h, stiffness, seconds, [&] { return euler.euler_maruyama(); });
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 20.0;
  afm::CommandLine app("thermostats", "Bias of <(y - y0)^2> of a heated tip at rest, relative, and time per tau [us].");
  app.option("seconds", seconds, "for each row", afm::kPositive);
  return app.run(argc, argv, [&] {
    std::printf("method,knob,stiffness,bias,std_error,us_per_tau\n");
    for (const double kicks_per_tau : kKicks) measure_kicks(seconds, kicks_per_tau);
    for (const double stiffness : kStiffness) {
      for (const double h : kSteps) measure_penalty(seconds, h, stiffness);
    }
    return 0;
  });
}
