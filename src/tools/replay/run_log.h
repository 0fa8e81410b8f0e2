// What the run in a recording is a function of: the configuration of each epoch and its commands, complete and in
// order.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "epoch_log.h"
#include "message_stream.h"
#include "recording.h"

namespace afm::replay {

class RunLog {
 public:
  // Throws Problem when something is missing, out of order, or makes no sense.
  explicit RunLog(const Recording& recording);

  const EpochLog& epoch(std::uint32_t number) const;  // throws Problem when there is none
  const std::map<std::uint32_t, EpochLog>& epochs() const { return epochs_; }

 private:
  void take(const afm_emulator::Configuration& configuration, const std::string& where);
  void take(const afm_emulator::Checkpoint& checkpoint, const std::string& where);
  // Of commands of one kind: where they belong, and the sequence number of the last one.
  template <class Message>
  struct Kind {
    std::vector<Message> EpochLog::*messages;
    std::optional<std::uint32_t> last;
  };
  template <class Message>
  void take_all(const Recording& recording, const RecordedBag& bag, const char* topic, Kind<Message>& kind);
  template <class Message>
  void take(const Message& message, const std::string& where, Kind<Message>& kind);
  void take_stretches(const Recording& recording, const RecordedBag& bag);

  std::map<std::uint32_t, EpochLog> epochs_;
  std::optional<std::uint32_t> last_checkpoint_;  // sequence number
  const afm_emulator::Configuration* last_configuration_ = nullptr;
  Kind<afm_emulator::AppliedDrag> drags_{&EpochLog::drags, std::nullopt};
  Kind<afm_emulator::AppliedParameters> changes_{&EpochLog::changes, std::nullopt};
};

}  // namespace afm::replay
