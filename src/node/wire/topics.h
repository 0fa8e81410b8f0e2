// Names below the node's private namespace, and how many messages wait for a slow subscriber.
#pragma once

namespace afm::node {

constexpr char kDragVelocityTopic[] = "drag_velocity";
constexpr char kRestHeightTopic[] = "rest_height";
constexpr char kDeflectionTopic[] = "deflection";
constexpr char kImpactsTopic[] = "impacts";
constexpr char kFrictionTopic[] = "friction";
constexpr char kAppliedDragTopic[] = "applied_drag";
constexpr char kAppliedParametersTopic[] = "applied_parameters";
constexpr char kStatusTopic[] = "status";
constexpr char kConfigurationTopic[] = "configuration";
constexpr char kDigestTopic[] = "digest";
constexpr char kCheckpointTopic[] = "checkpoint";
constexpr char kRecordingTopic[] = "recording";  // in bags alone

// of the protocol of dynamic_reconfigure
constexpr char kDescriptionsTopic[] = "parameter_descriptions";
constexpr char kUpdatesTopic[] = "parameter_updates";
constexpr char kSetParametersService[] = "set_parameters";

constexpr char kResetService[] = "reset";
constexpr char kPauseService[] = "pause";
constexpr char kStepService[] = "step";
constexpr char kStartRecordingService[] = "start_recording";
constexpr char kStopRecordingService[] = "stop_recording";

// A message every batch: 0.1 s at the fastest batch rate; a queue of 10 lost nothing, one of 1 lost 2 %.
constexpr unsigned kBatchQueueSize = 100;
// Commands, of which none may be lost on the way in or out, as nobody would count it. Ten times what the stepping
// thread takes before it refuses more, which is counted.
constexpr unsigned kCommandQueueSize = 10000;
// One a second.
constexpr unsigned kDigestQueueSize = 100;
// A second of status.
constexpr unsigned kStatusQueueSize = 10;
// Only the latest matters.
constexpr unsigned kConfigurationQueueSize = 10;
// Every 2000 commands.
constexpr unsigned kCheckpointQueueSize = 100;

}  // namespace afm::node
