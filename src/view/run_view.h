// A run as far as it is known, live or replayed. Lengths in a, times in tau.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "afm/model.h"
#include "afm/state.h"
#include "afm/units.h"

namespace afm::view {

constexpr double kPictureRate = 30.0;  // [1/s] of wall time
constexpr double kPathTau = 8.0;       // how far back a path is drawn, at most [tau]

// Where the tip was, in the lab: along the surface, a crest at every whole number, and over mid-surface. For an impact
// also what happened there.
struct Place {
  ModelTime time;
  double x = 0.0, y = 0.0;
  bool contact = false;  // from here on
  double energy_loss = 0.0;
  ImpactKind kind = ImpactKind::impact;
};

class RunView {
 public:
  void take(const afm_emulator::Configuration& message);
  void take(const afm_emulator::Applied& message);
  // Samples before a gap are forgotten; those of an epoch of which nothing else is known yet are not taken.
  void take(const afm_emulator::Deflection& message);
  void take(const afm_emulator::ImpactArray& message);
  void take(const afm_emulator::Friction& message) { friction_ = message; }

  // False as long as something is missing, or is of another epoch. The functions below need it.
  bool complete() const;

  const afm_emulator::Configuration& configuration() const { return *configuration_; }
  const afm_emulator::Applied& applied() const { return applied_.back(); }
  const std::optional<afm_emulator::Friction>& friction() const { return friction_; }
  const Units& units() const { return *units_; }
  const Model& model() const { return model_; }

  ModelTime now() const { return samples_.back().time; }
  Place holder() const { return holder_; }  // now
  double eta() const { return eta_; }
  // Samples and impacts in (from, now()], in order of time. At most so many, evenly.
  std::vector<Place> samples_since(const ModelTime& from, std::size_t most) const;
  std::vector<Place> impacts_since(const ModelTime& from, std::size_t most) const;

 private:
  bool in_contact(const Place& sample) const;
  Place place(const afm_emulator::Impact& impact) const;
  void forget_old();

  std::optional<afm_emulator::Configuration> configuration_;
  std::deque<afm_emulator::Applied> applied_;  // in force at the last sample, and what was applied after it
  std::optional<afm_emulator::Friction> friction_;
  std::optional<Units> units_;
  Model model_;
  Place holder_;
  double eta_ = 0.0;
  std::deque<Place> samples_;
  std::deque<afm_emulator::Impact> impacts_;
  std::uint32_t samples_epoch_ = 0, impacts_epoch_ = 0;
  std::uint64_t next_sample_ = 0, next_impact_ = 0;
  std::optional<bool> contact_before_;  // the first impact kept; empty: that is not known
};

}  // namespace afm::view
