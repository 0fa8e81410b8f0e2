// What a bag must be told first, so that a run under way can be simulated again from the start of its epoch: the
// configuration, and every drag command and change of parameters since then.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>

#include <cstddef>
#include <deque>

namespace afm::node {

class RunHistory {
 public:
  // Some 40 MB; days of commands by hand, 40 minutes of one every batch. Past it the oldest are forgotten: the history
  // then begins at a model time above 0, and a checker sees that it is not whole.
  static constexpr std::size_t kMaxCommands = 250000;
  // likewise
  static constexpr std::size_t kMaxChanges = 50000;

  void remember(const boost::shared_ptr<const afm_emulator::Configuration>& configuration) {
    configuration_ = configuration;
    commands_.clear();  // a new epoch
    changes_.clear();
  }
  void remember(const boost::shared_ptr<const afm_emulator::AppliedDrag>& command) {
    commands_.push_back(*command);
    if (commands_.size() > kMaxCommands) commands_.pop_front();
  }
  void remember(const boost::shared_ptr<const afm_emulator::AppliedParameters>& change) {
    changes_.push_back(*change);
    if (changes_.size() > kMaxChanges) changes_.pop_front();
  }
  // all other messages are of their moment
  template <class Message>
  void remember(const boost::shared_ptr<const Message>&) {}

  const boost::shared_ptr<const afm_emulator::Configuration>& configuration() const { return configuration_; }
  const std::deque<afm_emulator::AppliedDrag>& commands() const { return commands_; }
  const std::deque<afm_emulator::AppliedParameters>& changes() const { return changes_; }

 private:
  boost::shared_ptr<const afm_emulator::Configuration> configuration_;
  std::deque<afm_emulator::AppliedDrag> commands_;
  std::deque<afm_emulator::AppliedParameters> changes_;
};

}  // namespace afm::node
