// The running digests of one epoch, from its messages. Samples, impacts and commands are counted by
// themselves, so that their digests do not depend on how they were put into batches.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Digest.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include "digest.h"

namespace afm::node {

class RunDigest {
 public:
  RunDigest() = default;
  // An epoch begins. Stamps and sequence numbers are no part of a run.
  explicit RunDigest(const afm_emulator::Configuration& configuration);
  // Goes on from what was reported.
  explicit RunDigest(const afm_emulator::Digest& message);

  void add(const afm_emulator::Deflection& batch);
  void begin_samples(std::uint64_t first);  // with this one: those before are not covered
  void add(const afm_emulator::ImpactArray& batch);
  void add(const afm_emulator::Friction& estimate);
  void add(const afm_emulator::AppliedDrag& command);
  void add(const afm_emulator::AppliedParameters& change);

  afm_emulator::Digest message() const;  // all but the header

 private:
  std::uint32_t epoch_ = 0;
  afm_emulator::ModelTime time_;
  std::uint64_t first_sample_ = 0, samples_ = 0, impacts_ = 0, commands_ = 0, estimates_ = 0;
  std::uint64_t configuration_digest_ = 0;
  Digest samples_digest_, impacts_digest_, commands_digest_, estimates_digest_;
};

}  // namespace afm::node
