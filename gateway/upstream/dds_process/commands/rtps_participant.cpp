// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/commands/rtps_participant.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/qos/ReaderQos.h>

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::int32_t kMostOutOfOrder = 4096;
constexpr std::uint32_t kUsualPayload = 256;

fdds::OwnershipQosPolicyKind ownership_of(const LivelinessLease& asked) {
  return asked.topic == CommandTopic::command ? fdds::EXCLUSIVE_OWNERSHIP_QOS : fdds::SHARED_OWNERSHIP_QOS;
}

eprosima::fastrtps::Duration_t duration(SteadyNs length) {
  return {static_cast<std::int32_t>(length / kSecond), static_cast<std::uint32_t>(length % kSecond)};
}

rtps::ReaderAttributes reader_attributes(const LivelinessLease& asked) {
  rtps::ReaderAttributes out;
  out.endpoint.reliabilityKind = rtps::RELIABLE;
  out.endpoint.durabilityKind = rtps::VOLATILE;
  out.endpoint.topicKind = rtps::WITH_KEY;
  out.endpoint.ownershipKind = ownership_of(asked);
  if (asked.length != 0) {
    out.liveliness_kind_ = fdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
    out.liveliness_lease_duration = duration(asked.length);
  }
  // DDS-Security finds a topic's rules by this name; a DataReader has it from its topic.
  out.endpoint.properties.properties().emplace_back("topic_name", kCommandTopicName);
  return out;
}

eprosima::fastrtps::ReaderQos announced_qos(const LivelinessLease& asked) {
  eprosima::fastrtps::ReaderQos out;
  out.m_reliability.kind = fdds::RELIABLE_RELIABILITY_QOS;
  out.m_durability.kind = fdds::VOLATILE_DURABILITY_QOS;
  out.m_ownership.kind = ownership_of(asked);
  if (asked.length != 0) {
    out.m_liveliness.kind = fdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
    out.m_liveliness.lease_duration = duration(asked.length);
  }
  return out;
}

// What is a participant's own is left out: its GUID prefix and its number.
rtps::RTPSParticipantAttributes attributes_of(const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  rtps::RTPSParticipantAttributes out;
  const auto& wire = qos.wire_protocol();
  out.builtin = wire.builtin;
  out.port = wire.port;
  out.throughputController = wire.throughput_controller;
  out.defaultUnicastLocatorList = wire.default_unicast_locator_list;
  out.defaultMulticastLocatorList = wire.default_multicast_locator_list;
  out.default_external_unicast_locators = wire.default_external_unicast_locators;
  out.ignore_non_matching_locators = wire.ignore_non_matching_locators;
  const auto& transport = qos.transport();
  out.userTransports = transport.user_transports;
  out.useBuiltinTransports = transport.use_builtin_transports;
  out.sendSocketBufferSize = transport.send_socket_buffer_size;
  out.listenSocketBufferSize = transport.listen_socket_buffer_size;
  out.allocation = qos.allocation();
  out.properties = qos.properties();
  out.flow_controllers = qos.flow_controllers();
  out.setName("axisgate commands");
  return out;
}

}  // namespace

RtpsParticipant::RtpsParticipant(std::uint32_t domain, const eprosima::fastdds::dds::DomainParticipantQos& qos)
    : participant_(rtps::RTPSDomain::createParticipant(domain, attributes_of(qos))) {
  if (participant_ == nullptr)
    throw program::StartError(link::kExitCannotServe, "the DDS participant that reads commands cannot be made");
}

RtpsParticipant::~RtpsParticipant() { rtps::RTPSDomain::removeRTPSParticipant(participant_); }

rtps::HistoryAttributes command_history() {
  return {rtps::DYNAMIC_REUSABLE_MEMORY_MODE, kUsualPayload, 0, kMostOutOfOrder};
}

rtps::RTPSReader& RtpsParticipant::make_reader(const LivelinessLease& asked, rtps::ReaderHistory& history,
                                               rtps::ReaderListener& listener) {
  rtps::ReaderAttributes attributes = reader_attributes(asked);
  rtps::RTPSReader* const made = rtps::RTPSDomain::createRTPSReader(participant_, attributes, &history, &listener);
  const GuardedType<AxisCommandPubSubType> type;
  eprosima::fastrtps::TopicAttributes described(kCommandTopicName, type.getName(), rtps::WITH_KEY);
  described.auto_fill_type_object = false;
  described.auto_fill_type_information = false;
  if (made == nullptr || !participant_->registerReader(made, described, announced_qos(asked)))
    throw program::StartError(link::kExitCannotServe, "a reader of topic axisgate/axis_command cannot be made");
  return *made;
}

void RtpsParticipant::end_reader(rtps::RTPSReader& reader) { rtps::RTPSDomain::removeRTPSReader(&reader); }

}  // namespace axisgate::dds
