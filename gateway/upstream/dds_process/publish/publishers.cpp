// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/publish/publishers.hpp"

#include <axisgatePubSubTypes.h>

#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"
#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/writer_qos.hpp"

namespace axisgate::dds {
namespace {

/// Axes 1 to 499, and the gateway itself as 0.
constexpr std::int32_t kMostStates = 500;
constexpr std::int32_t kEventsKept = 16;

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

Publishers::Publishers(Participant& participant, const GatewayId& gateway, program::Wake& wake)
    : gateway_(gateway),
      axis_state_(participant.make_writer(kStateTopicName, "axis_state", type<AxisStatePubSubType>(),
                                          writer_qos(1, kMostStates, true), gateway_user_data(gateway.key))),
      axis_event_(participant.make_writer("axisgate/axis_event", "axis_event", type<AxisEventPubSubType>(),
                                          writer_qos(kEventsKept, kMostStates, true))),
      gateway_state_(participant.make_writer(kGatewayTopicName, "gateway_state", type<GatewayStatePubSubType>(),
                                             writer_qos(1, 1, true))),
      command_reply_(participant, "command_reply", type<CommandReplyPubSubType>(), gateway_, wake),
      object_reply_(participant, "object_reply", type<ObjectReplyPubSubType>(), gateway_, wake) {}

bool Publishers::publish(const Record& record, SteadyNs now, ClockDifference difference) {
  if (const auto* state = std::get_if<StateRecord>(&record)) {
    write(axis_state_, to_idl(*state, difference, gateway_));
  } else if (const auto* event = std::get_if<EventRecord>(&record)) {
    write(axis_event_, to_idl(*event, difference, gateway_));
  } else if (const auto* gateway = std::get_if<GatewayRecord>(&record)) {
    write(gateway_state_, to_idl(*gateway, now, difference, gateway_));
  } else if (const auto* reply = std::get_if<ReplyRecord>(&record)) {
    command_reply_.write(*reply, now);
  } else if (const auto* object = std::get_if<ObjectReplyRecord>(&record)) {
    object_reply_.write(*object, now);
  } else {
    return false;
  }
  return true;
}

void Publishers::publish_held(SteadyNs now) {
  command_reply_.write_held(now);
  object_reply_.write_held(now);
}

}  // namespace axisgate::dds
