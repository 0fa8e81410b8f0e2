// One random model under random commands, with every invariant checked after every segment.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "afm/units.h"
#include "trials/tip_watch.h"

namespace afm {

class StressScene {
 public:
  // any: model, drag speed and bath; mica: the paper's model at any usual cutoff, dragged at up to 9 a/tau; shipped:
  // the node's own, commands as scripts/soak sends them, and no batch of the node may spend its budget; lever: a lever
  // on a crystal under a load, in a bath or not.
  enum class Kind { any, mica, shipped, lever };
  StressScene(std::uint64_t seed, Kind kind);

  // Runs for `tau`; false at the first violation.
  bool run(std::int64_t tau);

  std::string report() const;  // what was violated, where, and how to get there again
  const TipCount& count() const { return tip_.count(); }
  std::uint64_t most_events() const { return most_events_; }  // in a batch of the node

 private:
  Model random_model();
  Model random_lever();
  double random_rest_height();
  Bath random_bath();
  FreeState random_start();
  double random_eta();
  double mica_eta();
  void command();
  bool keeps_budget();
  double decades(double low, double high) { return std::pow(10.0, within(std::log10(low), std::log10(high))); }
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool one_in(int n) { return within(0.0, n) < 1.0; }

  std::uint64_t seed_;
  Kind kind_;
  std::mt19937_64 random_;
  bool has_bath_;  // most of the time; or never
  SiModel lever_;
  Model model_;
  double eta_;
  TipWatch tip_;
  ModelTime batch_begin_;
  std::uint64_t events_before_ = 0;  // this batch
  std::uint64_t most_events_ = 0;    // in a batch
  bool spent_ = false;
};

}  // namespace afm
