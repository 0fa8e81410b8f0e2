#include "run_digest.h"

#include <ros/serialization.h>

#include <vector>

#include "afm/model.h"

namespace afm::node {
namespace {

void add(const afm_emulator::ModelTime& time, Digest& digest) {
  digest.add(static_cast<std::uint64_t>(time.tau));
  digest.add(time.phase);
}

template <class Applied>
void add_level(const Applied& applied, Digest& digest) {
  digest.add(std::uint64_t{applied.model == name(ModelKind::hammer)});
  digest.add(applied.contact_tolerance);
  digest.add(applied.expected_error);
  digest.add(applied.energy_dropped);
}

// Of the bytes on the wire, a word a byte, without stamp and sequence number.
std::uint64_t digest_of(afm_emulator::Configuration configuration) {
  configuration.header = std_msgs::Header();
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(configuration));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, configuration);
  Digest digest;
  for (const std::uint8_t byte : bytes) digest.add(std::uint64_t{byte});
  return digest.value();
}

}  // namespace

RunDigest::RunDigest(const afm_emulator::Configuration& configuration)
    : epoch_(configuration.epoch), configuration_digest_(digest_of(configuration)) {}

RunDigest::RunDigest(const afm_emulator::Digest& told)
    : epoch_(told.epoch),
      time_(told.time),
      first_sample_(told.first_sample),
      samples_(told.samples),
      impacts_(told.impacts),
      commands_(told.commands),
      estimates_(told.estimates),
      configuration_digest_(told.configuration_digest),
      samples_digest_(told.samples_digest),
      impacts_digest_(told.impacts_digest),
      commands_digest_(told.commands_digest),
      estimates_digest_(told.estimates_digest) {}

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

void RunDigest::add(const afm_emulator::ImpactArray& batch) {
  for (const afm_emulator::Impact& impact : batch.impacts) {
    node::add(impact.time, impacts_digest_);
    impacts_digest_.add(impact.surface_phase);
    impacts_digest_.add(impact.normal_speed);
    impacts_digest_.add(impact.tangential_velocity);
    impacts_digest_.add(impact.energy_loss);
    impacts_digest_.add(std::uint64_t{impact.kind});
    impacts_digest_.add(std::uint64_t{impact.count});
  }
  impacts_ += batch.impacts.size();
}

void RunDigest::add(const afm_emulator::Friction& estimate) {
  node::add(estimate.time, estimates_digest_);
  for (const double figure : {estimate.drag_velocity, estimate.eta, estimate.force, estimate.force_std_error,
                              estimate.k_f, estimate.k_f_std_error, estimate.k_f_tau_per_m, estimate.energy_loss,
                              estimate.window_force, estimate.window_k_f, estimate.window_k_f_std_error}) {
    estimates_digest_.add(figure);
  }
  estimates_digest_.add(std::uint64_t{estimate.impact_count});
  time_ = estimate.time;
  ++estimates_;
}

void RunDigest::add(const afm_emulator::AppliedDrag& command) {
  node::add(command.time, commands_digest_);
  commands_digest_.add(command.drag_velocity);
  commands_digest_.add(std::uint64_t{command.first_impact});
  add_level(command, commands_digest_);
  ++commands_;
}

void RunDigest::add(const afm_emulator::AppliedParameters& change) {
  node::add(change.time, commands_digest_);
  for (const std::uint64_t number : {change.first_impact, change.first_sample, change.first_command}) {
    commands_digest_.add(number);
  }
  for (const double value : {change.restitution_gamma, change.cutoff_speed, change.rest_height_m,
                             change.sample_rate_hz, change.friction_window_tau}) {
    commands_digest_.add(value);
  }
  commands_digest_.add(change.samples_per_batch);
  commands_digest_.add(change.sample_period_tau);
  add_level(change, commands_digest_);
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
