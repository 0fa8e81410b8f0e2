#include "run_digest.h"

#include "message_bytes.h"

namespace afm::node {

RunDigest::RunDigest(const afm_emulator::Configuration& configuration)
    : epoch_(configuration.epoch), configuration_digest_(digest_of_message(configuration)) {}

RunDigest::RunDigest(const afm_emulator::Digest& message)
    : epoch_(message.epoch),
      time_(message.time),
      first_sample_(message.first_sample),
      samples_(message.samples),
      impacts_(message.impacts),
      commands_(message.commands),
      estimates_(message.estimates),
      configuration_digest_(message.configuration_digest),
      samples_digest_(message.samples_digest),
      impacts_digest_(message.impacts_digest),
      commands_digest_(message.commands_digest),
      estimates_digest_(message.estimates_digest) {}

void RunDigest::add(const afm_emulator::Deflection& batch) {
  for (std::size_t i = 0; i < batch.vertical.size() && i < batch.lateral.size(); ++i) {
    samples_digest_.add(batch.vertical[i]);
    samples_digest_.add(batch.lateral[i]);
  }
  samples_ += batch.vertical.size();
}

void RunDigest::begin_samples(std::uint64_t first) {
  first_sample_ = samples_ = first;
  samples_digest_ = Digest();
}

// Impact by impact, so that it does not matter how they are divided into messages.
void RunDigest::add(const afm_emulator::ImpactArray& batch) {
  for (const afm_emulator::Impact& impact : batch.impacts) add_message(impact, impacts_digest_);
  impacts_ += batch.impacts.size();
}

void RunDigest::add(const afm_emulator::Friction& estimate) {
  add_message(estimate, estimates_digest_);
  time_ = estimate.time;
  ++estimates_;
}

void RunDigest::add(const afm_emulator::AppliedDrag& command) {
  add_message(command, commands_digest_);
  ++commands_;
}

void RunDigest::add(const afm_emulator::AppliedParameters& change) {
  add_message(change, commands_digest_);
  ++commands_;
}

afm_emulator::Digest RunDigest::message() const {
  afm_emulator::Digest message;
  message.epoch = epoch_;
  message.time = time_;
  message.first_sample = first_sample_;
  message.samples = samples_;
  message.impacts = impacts_;
  message.commands = commands_;
  message.estimates = estimates_;
  message.configuration_digest = configuration_digest_;
  message.samples_digest = samples_digest_.value();
  message.impacts_digest = impacts_digest_.value();
  message.commands_digest = commands_digest_.value();
  message.estimates_digest = estimates_digest_.value();
  return message;
}

}  // namespace afm::node
