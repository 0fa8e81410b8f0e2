// What is known of a run, live or replayed. The topics come in any order: each message is taken by itself, and a picture is
// drawn when all that it needs is of one epoch.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Friction.h>

#include <optional>

#include "trace.h"

namespace afm::view {

class RunView {
 public:
  void take(const afm_emulator::Configuration& message);
  void take(const afm_emulator::Applied& message);
  void take(const afm_emulator::Deflection& message);
  void take(const afm_emulator::ImpactArray& message);
  void take(const afm_emulator::Friction& message) { friction_ = message; }

  // False as long as something is missing. The accessors below need it.
  bool complete() const;

  const afm_emulator::Configuration& configuration() const { return *configuration_; }
  const afm_emulator::Applied& applied() const { return *applied_; }
  const std::optional<afm_emulator::Friction>& friction() const { return friction_; }
  const Units& units() const { return *units_; }
  const Model& model() const { return model_; }
  const Trace& trace() const { return trace_; }
  const Holder& holder() const { return holder_; }
  ModelTime now() const { return trace_.samples().back().time; }

 private:
  void keep_enough();

  std::optional<afm_emulator::Configuration> configuration_;
  std::optional<afm_emulator::Applied> applied_;
  std::optional<afm_emulator::Friction> friction_;
  std::optional<Units> units_;
  Model model_;
  Trace trace_;
  Holder holder_;
};

constexpr double kPictureRate = 30.0;  // [1/s] of wall time
// How far back a path is drawn, at most [tau].
constexpr double kPathTau = 8.0;

}  // namespace afm::view
