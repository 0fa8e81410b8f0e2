// One random model under random commands, with every invariant checked after every arc.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "afm_emulator/tip.h"
#include "energy_ledger.h"

namespace afm {

struct StressCount {
  std::uint64_t arcs = 0, impacts = 0, bounces = 0, bursts = 0, contacts = 0, commands = 0;
  std::uint64_t most_arcs_in_a_tau = 0;
  double deepest = 0.0;          // below the surface [a], or part of the largest height if that is more than 1 a
  double worst_imbalance = 0.0;  // of the energy turned over
};

class StressScene {
 public:
  // mica: the paper's model at any usual cutoff, dragged at up to 9 a/tau; otherwise any model at any drag speed.
  StressScene(std::uint64_t seed, double contact_tolerance, bool mica);

  // Runs for `tau`; false at the first violation.
  bool run(std::int64_t tau);

  std::string report() const;  // what was violated, where, and how to get there again
  const StressCount& count() const { return count_; }

 private:
  Model random_model();
  FreeState random_start();
  double random_eta();
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool one_in(int n) { return within(0.0, n) < 1.0; }

  bool arc(const ModelTime& limit, Outcome& outcome);
  bool check_depth(const ModelTime& t);
  bool check_depths(const ModelTime& begin, const ModelTime& end);
  bool check_energy();
  bool check_rate();
  bool violated(const std::string& what);
  void enter(Outcome outcome);

  std::uint64_t seed_;
  bool mica_;
  std::mt19937_64 random_;
  Model model_;
  double eta_;
  Tip tip_;
  EnergyLedger ledger_;
  StressCount count_;
  std::uint64_t arcs_this_tau_ = 0;
  std::int64_t tau_ = 0;
  double sample_ = 0.0;
  std::string violation_;
};

}  // namespace afm
