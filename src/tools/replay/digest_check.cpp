#include "digest_check.h"

#include <memory>

#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

namespace afm::replay {
namespace {

MessageStream<afm_emulator::Digest> digests_of(const Recording& recording) {
  MessageStream<afm_emulator::Digest> digests(recording.topic(node::kDigestTopic));
  for (const auto& bag : recording.bags()) digests.add(bag->bag, bag->path);
  if (digests.size() == 0) throw Problem(Verdict::missing, recording.name() + ": holds no digest");
  return digests;
}

// Digests come once a second: a time far beyond the last is not followed for ever.
bool is_plausible(const afm_emulator::Digest& recorded, const Resimulation& simulation) {
  const ModelTime end = node::from_message(recorded.time);
  const ModelTime after = simulation.sample_time(recorded.samples);
  const ModelTime before = recorded.samples == 0 ? ModelTime{} : simulation.sample_time(recorded.samples - 1);
  return recorded.time.phase >= 0.0 && recorded.time.phase < 1.0 && before <= end && end <= after;
}

}  // namespace

DigestReport check_digests(const Recording& recording, const Progress& progress) {
  DigestReport report;
  const RunLog log(recording);
  auto digests = digests_of(recording);
  std::unique_ptr<Resimulation> simulation;
  std::optional<afm_emulator::Digest> last;
  for (; digests.head() != nullptr && !report.difference; digests.pop()) {
    const afm_emulator::Digest recorded = *digests.head();
    if (last) {
      const std::uint64_t gap = follows(last->header.seq, recorded.header.seq, digests.path() + ": " + digests.topic());
      if (gap > 0)
        throw Problem(Verdict::missing, digests.path() + ": " + std::to_string(gap) + " digests are missing");
    }
    if (!last || last->epoch != recorded.epoch) {
      simulation = std::make_unique<Resimulation>(log.epoch(recorded.epoch));
      report.last_equal = {};
      ++report.extent.epochs;
    }
    const ModelTime from = simulation->now(), end = node::from_message(recorded.time);
    afm_emulator::Digest simulated = recorded;
    if (is_plausible(recorded, *simulation)) {
      simulation->forget(recorded.samples, recorded.impacts);
      simulation->run_to(end, recorded.impacts);
      simulation->apply_commands(recorded.commands);
      simulated = simulation->digest().message();
      simulated.time = node::to_message(simulation->now());
    } else {
      simulated.samples = 0;
    }
    simulated.estimates = recorded.estimates;  // of batches, which are not read here
    simulated.estimates_digest = recorded.estimates_digest;
    report.extent.model_seconds += (simulation->now() - from) * simulation->time_unit();
    ++report.extent.digests;
    if (const auto field = find_difference(recorded, simulated)) {
      report.difference = Difference{*field, recorded.epoch, 0, end, simulation->last_command(), std::nullopt};
    } else {
      report.last_equal = end;
    }
    last = recorded;
    progress(static_cast<double>(report.extent.digests) / static_cast<double>(digests.size()), end);
  }
  if (last) {
    report.extent.samples = last->samples;
    report.extent.impacts = last->impacts;
    report.extent.commands = last->commands;
  }
  return report;
}

}  // namespace afm::replay
