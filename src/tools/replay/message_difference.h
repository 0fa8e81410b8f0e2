// Where two messages differ, bit for bit. Stamps and sequence numbers are of their moment and not looked at.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Digest.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <cstddef>
#include <optional>
#include <string>

namespace afm::replay {

// The first field that differs, and its values as text: 17 digits and the bits of a number.
struct FieldDifference {
  std::string field, first, second;
  std::size_t index = 0;  // in an array
};

std::optional<FieldDifference> find_difference(const afm_emulator::Deflection& a, const afm_emulator::Deflection& b);
std::optional<FieldDifference> find_difference(const afm_emulator::ImpactArray& a, const afm_emulator::ImpactArray& b);
std::optional<FieldDifference> find_difference(const afm_emulator::Friction& a, const afm_emulator::Friction& b);
std::optional<FieldDifference> find_difference(const afm_emulator::AppliedDrag& a, const afm_emulator::AppliedDrag& b);
std::optional<FieldDifference> find_difference(const afm_emulator::AppliedParameters& a,
                                               const afm_emulator::AppliedParameters& b);
std::optional<FieldDifference> find_difference(const afm_emulator::Configuration& a,
                                               const afm_emulator::Configuration& b);
std::optional<FieldDifference> find_difference(const afm_emulator::Checkpoint& a, const afm_emulator::Checkpoint& b);
std::optional<FieldDifference> find_difference(const afm_emulator::Digest& a, const afm_emulator::Digest& b);

}  // namespace afm::replay
