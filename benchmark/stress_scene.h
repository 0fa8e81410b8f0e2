// One random model under random commands, with every invariant checked after every arc.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "tip_watch.h"

namespace afm {

class StressScene {
 public:
  // mica: the paper's model at any usual cutoff, dragged at up to 9 a/tau; otherwise any model at any drag speed.
  StressScene(std::uint64_t seed, double contact_tolerance, bool mica);

  // Runs for `tau`; false at the first violation.
  bool run(std::int64_t tau);

  std::string report() const;  // what was violated, where, and how to get there again
  const TipCount& count() const { return tip_.count(); }

 private:
  Model random_model();
  FreeState random_start();
  double random_eta();
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool one_in(int n) { return within(0.0, n) < 1.0; }

  std::uint64_t seed_;
  bool mica_;
  std::mt19937_64 random_;
  Model model_;
  double eta_;
  TipWatch tip_;
};

}  // namespace afm
