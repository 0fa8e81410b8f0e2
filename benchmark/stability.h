// Scenes on which methods fail, each with a measure of how.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rivals/method.h"

namespace afm {

enum class Verdict { right, inaccurate, misses, phantom, stalls, blows_up };
const char* name_of(Verdict verdict);

struct Effort {
  bool quick = false;
  double seconds = 5.0;  // of this thread for one cell
};

struct Cell {
  Verdict verdict = Verdict::right;
  double number = 0.0;
  std::string meaning;      // of the number
  double ns_per_tau = 0.0;  // of model time
};

constexpr double kRightError = 1e-6;       // of a flight, a returned state, a balance of energy
constexpr double kRightFriction = 1e-3;    // of K_f, periodic
constexpr double kRightStatistics = 0.05;  // of K_f, chaotic: runs are short

struct StabilityScene {
  std::string name, about;
  std::function<Cell(const rivals::MethodSpec& method, double setting, const Effort& effort)> measure;
  // where a scene is about settings, those it is run with; otherwise the usual ones
  std::function<double(const rivals::MethodSpec& method)> setting = nullptr;
  double right_below = kRightError;  // the largest error of a cell that is right
};

// What the emulator's users run: the default tolerance. It is a column of its own beside bounces one by one.
double usual_setting(const rivals::MethodSpec& method);

std::vector<StabilityScene> flight_scenes(const Effort& effort);  // against quad precision, flight by flight
std::vector<StabilityScene> run_scenes();                         // K_f, energy, pace

}  // namespace afm
