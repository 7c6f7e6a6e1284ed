#include "gateway/upstream/dds_process/publishers.hpp"

#include <axisgatePubSubTypes.h>
#include <sensor_msgsPubSubTypes.h>

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::Duration_t;

/// Axes 1 to 499, and the gateway itself as 0.
constexpr std::int32_t kMostInstances = 500;
constexpr std::int32_t kEventsKept = 16;
/// Replies that a reader may be behind with, per axis.
constexpr std::int32_t kRepliesKept = 64;
constexpr std::int32_t kJointStatesKept = 10;
/// A lost packet is noticed after this; the library's 3 s would throttle a full history.
const Duration_t kHeartbeatPeriod(0, 20'000'000);
const Duration_t kMostBlocking(0, 1'000'000);

fastdds::DataWriterQos reliable(std::int32_t depth, std::int32_t instances, bool transient_local) {
  fastdds::DataWriterQos qos;
  qos.reliability().kind = fastdds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = kMostBlocking;
  qos.durability().kind = transient_local ? fastdds::TRANSIENT_LOCAL_DURABILITY_QOS : fastdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fastdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.resource_limits().max_instances = instances;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().max_samples = depth * instances;
  qos.resource_limits().allocated_samples = 0;
  qos.reliable_writer_qos().times.heartbeatPeriod = kHeartbeatPeriod;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

template <typename Type>
fastdds::TypeSupport type() {
  return fastdds::TypeSupport(new Type());
}

template <typename Sample>
void write(fastdds::DataWriter& writer, Sample sample) {
  // What cannot be sent is in the history, or is overtaken by the next sample: there is nobody to tell.
  writer.write(&sample);
}

}  // namespace

Publishers::Publishers(Participant& participant, bool ros2)
    : axis_state_(participant.make_writer("axisgate/axis_state", "axis_state", type<AxisStatePubSubType>(),
                                          reliable(1, kMostInstances, true))),
      axis_event_(participant.make_writer("axisgate/axis_event", "axis_event", type<AxisEventPubSubType>(),
                                          reliable(kEventsKept, kMostInstances, true))),
      gateway_state_(participant.make_writer("axisgate/gateway_state", "gateway_state", type<GatewayStatePubSubType>(),
                                             reliable(1, 1, true))),
      command_reply_(participant.make_writer("axisgate/command_reply", "command_reply", type<CommandReplyPubSubType>(),
                                             reliable(kRepliesKept, kMostInstances, false))),
      object_reply_(participant.make_writer("axisgate/object_reply", "object_reply", type<ObjectReplyPubSubType>(),
                                            reliable(kRepliesKept, kMostInstances, false))) {
  if (ros2) {
    joint_states_ = &participant.make_writer("rt/joint_states", "joint_states",
                                             type<sensor_msgs::msg::dds_::JointState_PubSubType>(),
                                             reliable(kJointStatesKept, 1, false));
  }
}

bool Publishers::publish(const Record& record, SteadyNs now, ClockDifference difference) {
  if (const auto* state = std::get_if<StateRecord>(&record)) {
    write(axis_state_, to_idl(*state, difference));
    if (joint_states_ != nullptr) joints_.on_state(*state);
  } else if (const auto* event = std::get_if<EventRecord>(&record)) {
    write(axis_event_, to_idl(*event, difference));
  } else if (const auto* gateway = std::get_if<GatewayRecord>(&record)) {
    write(gateway_state_, to_idl(*gateway, now, difference));
  } else if (const auto* reply = std::get_if<ReplyRecord>(&record)) {
    write(command_reply_, to_idl(*reply));
  } else if (const auto* object = std::get_if<ObjectReplyRecord>(&record)) {
    write(object_reply_, to_idl(*object));
  } else {
    return false;
  }
  return true;
}

void Publishers::end_batch(ClockDifference difference) {
  if (joint_states_ != nullptr && joints_.due()) write(*joint_states_, joints_.take(difference));
}

}  // namespace axisgate::dds
