// The rows of speed_accuracy, and the two kinds of scene that give them.
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "flights.h"
#include "rivals/method.h"

namespace afm {

struct Contender {
  const rivals::MethodSpec* spec;
  double setting;
};

struct SpeedRow {
  Contender contender{};
  std::string scene;
  double ns = 0.0, exact_ns = 0.0, ratio = 0.0;  // per impact; ours in the same rounds
  double error_median = 0.0, error_p99 = 0.0, error_max = 0.0;
  long long missed = 0, phantom = 0, impacts = 0;
  std::vector<double> errors{};  // for the rows that pool scenes
  double ns_per_tau = 0.0;       // of runs for K_f
};

using Progress = std::function<void(const std::string& scene, const Contender& contender)>;

// All contenders on one scene's flights, in turns, `rounds` times or until one has used `most_seconds`.
std::vector<SpeedRow> measure_flights(const FlightScene& scene, const std::vector<Contender>& contenders, int rounds,
                                      double most_seconds, const Progress& progress);

// One row a contender over all those scenes.
std::vector<SpeedRow> pool(const std::vector<std::vector<SpeedRow>>& scenes, const std::string& name);

// K_f from a run of impact after impact. The error is that of K_f, and the impacts missed or too many are those against
// the reference's rate.
struct FrictionScene {
  std::string name;
  Model model;
  double eta;
  TipState start;
  double K_f, impacts_per_tau;  // reference
  double chance;                // standard deviation of K_f between runs of ours of the same length, over K_f
};

FrictionScene even_scene(double eta);  // K_f in closed form
// K_f of our own impacts one by one, over `tau`; where the motion is chaotic over a hundred runs of `tau`.
FrictionScene long_run_scene(const std::string& name, double eta, double cutoff_share, double tau, bool chaotic);
std::vector<SpeedRow> measure_friction(const FrictionScene& scene, const std::vector<Contender>& contenders, double tau,
                                       double most_seconds, const Progress& progress);

void print_header(std::FILE* out);
void print(const SpeedRow& row, std::FILE* out);

// Can it run an emulator? Processor time per second of model time against the error of K_f.
void print_pace_header(std::FILE* out);
void print_pace(const FrictionScene& scene, const SpeedRow& row, std::FILE* out);

}  // namespace afm
