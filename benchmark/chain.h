// A run of a method from impact to impact, with its totals: time, energy, impacts, and what it cost.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "afm/model.h"
#include "afm/state.h"

namespace afm {

struct ChainResult {
  double tau = 0.0;  // reached
  double energy = 0.0;
  std::uint64_t impacts = 0;
  double seconds = 0.0;
  bool gave_up = false;   // the method said that it cannot go on
  bool diverged = false;  // it left all bounds
  bool stuck = false;     // a thousand impacts have passed no time
  bool finished = true;   // false: stuck, or the seconds were spent first
  TipState end{};

  bool sound() const { return !gave_up && !diverged && !stuck; }
  double K_f(double eta) const { return energy / (eta * eta * tau); }
};

// A method over model time, from one state to another: goes on for `tau`, with `eta`, until that, `most_impacts` or
// `most_seconds` of this thread are over. Ours is the tip as the emulator has it, with bursts and contact.
using Runner = std::function<ChainResult(double tau, double eta, std::uint64_t most_impacts, double most_seconds)>;

Runner make_tip_runner(const Model& model, double eta, const TipState& start, double tolerance);
// By the method's name; `exact` is the tip, and its setting the contact tolerance.
Runner make_runner(const std::string& method, double setting, const Model& model, double eta, const TipState& start);

// Of the orbit of even eta, in closed form (docs/model.md).
double even_K_f(const Model& model);

constexpr std::uint64_t kAnyImpacts = ~std::uint64_t{0};
constexpr double kForever = 1e9;  // [s]

}  // namespace afm
