// What a bag must contain first, so that a run under way can be simulated again: the configuration, the last
// checkpoint, and every drag command and change of parameters since then, with those in force there.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Configuration.h>

#include <deque>

namespace afm::node {

class RunHistory {
 public:
  void remember(const boost::shared_ptr<const afm_emulator::Configuration>& configuration) {
    configuration_ = configuration;
    checkpoint_.reset();  // a new epoch
    commands_.clear();
    changes_.clear();
  }
  // It stands for all before it. Readers who do not simulate still find the last of each.
  void remember(const boost::shared_ptr<const afm_emulator::Checkpoint>& checkpoint) {
    checkpoint_ = checkpoint;
    keep_last(commands_);
    keep_last(changes_);
  }
  void remember(const boost::shared_ptr<const afm_emulator::AppliedDrag>& command) { commands_.push_back(command); }
  void remember(const boost::shared_ptr<const afm_emulator::AppliedParameters>& change) { changes_.push_back(change); }
  // all other messages are of their moment
  template <class Message>
  void remember(const boost::shared_ptr<const Message>&) {}

  template <class Message>
  using Messages = std::deque<boost::shared_ptr<const Message>>;

  const boost::shared_ptr<const afm_emulator::Configuration>& configuration() const { return configuration_; }
  const boost::shared_ptr<const afm_emulator::Checkpoint>& checkpoint() const { return checkpoint_; }  // null: none yet
  const Messages<afm_emulator::AppliedDrag>& commands() const { return commands_; }
  const Messages<afm_emulator::AppliedParameters>& changes() const { return changes_; }

 private:
  template <class Message>
  static void keep_last(Messages<Message>& messages) {
    if (messages.size() > 1) messages.erase(messages.begin(), messages.end() - 1);
  }

  boost::shared_ptr<const afm_emulator::Configuration> configuration_;
  boost::shared_ptr<const afm_emulator::Checkpoint> checkpoint_;
  Messages<afm_emulator::AppliedDrag> commands_;
  Messages<afm_emulator::AppliedParameters> changes_;
};

}  // namespace afm::node
