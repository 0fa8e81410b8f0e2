// What took effect in a run: drag velocities and changes of parameters.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>

#include <string>
#include <variant>

#include "node/wire/message_conversion.h"

namespace afm::replay {

using Applied = std::variant<afm_emulator::AppliedDrag, afm_emulator::AppliedParameters>;

inline ModelTime time_of(const Applied& applied) {
  return std::visit([](const auto& message) { return node::from_message(message.time); }, applied);
}
inline std::uint64_t first_impact_of(const Applied& applied) {
  return std::visit([](const auto& message) { return message.first_impact; }, applied);
}
std::string to_text(const Applied& applied);

}  // namespace afm::replay
