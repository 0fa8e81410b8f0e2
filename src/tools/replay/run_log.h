// What the run in a recording is a function of: the configuration of each epoch and its commands, complete and in order.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/Configuration.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "message_stream.h"
#include "recording.h"

namespace afm::replay {

struct EpochLog {
  afm_emulator::Configuration configuration;
  std::vector<afm_emulator::AppliedDrag> commands;  // the first at model time 0
};

class RunLog {
 public:
  // Throws Problem when something is missing, out of order, or makes no sense.
  explicit RunLog(const Recording& recording);

  const EpochLog& epoch(std::uint32_t number) const;  // throws Problem when there is none
  const std::map<std::uint32_t, EpochLog>& epochs() const { return epochs_; }

 private:
  void take(const afm_emulator::Configuration& configuration, const std::string& where);
  void take_all(MessageStream<afm_emulator::AppliedDrag>& commands, const std::string& where);
  void take(const afm_emulator::AppliedDrag& command, const std::string& where);

  std::map<std::uint32_t, EpochLog> epochs_;
  const afm_emulator::Configuration* last_configuration_ = nullptr;
  std::optional<std::uint32_t> last_command_;  // sequence number
};

}  // namespace afm::replay
