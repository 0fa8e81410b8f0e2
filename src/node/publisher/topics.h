// Topics below the node's private namespace, and how many messages wait for a slow subscriber.
#pragma once

namespace afm::node {

constexpr char kDeflectionTopic[] = "deflection";
constexpr char kImpactsTopic[] = "impacts";
constexpr char kFrictionTopic[] = "friction";
constexpr char kAppliedTopic[] = "applied";
constexpr char kConfigurationTopic[] = "configuration";

// A message every batch: 0.1 s at the fastest batch rate; a queue of 10 lost nothing, one of 1 lost 2 %.
constexpr unsigned kBatchQueueSize = 100;
// Commands, of which none may be lost on the way in or out, as nobody would count it. Ten times what the running thread
// takes before it refuses more, which is counted.
constexpr unsigned kCommandQueueSize = 10000;
// A second of status.
constexpr unsigned kStatusQueueSize = 10;
// Only the latest matters.
constexpr unsigned kLatchedQueueSize = 10;

}  // namespace afm::node
