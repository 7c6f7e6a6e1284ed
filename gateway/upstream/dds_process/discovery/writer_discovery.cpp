// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/discovery/writer_discovery.hpp"

#include <fastrtps/utils/IPLocator.h>

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::rtps::WriterDiscoveryInfo;

std::string where(const eprosima::fastrtps::rtps::WriterProxyData& writer) {
  for (const auto& locator : writer.remote_locators().unicast) {
    if (locator.kind == LOCATOR_KIND_UDPv4) return eprosima::fastrtps::rtps::IPLocator::toIPv4string(locator);
  }
  return {};
}

LivelinessKind to_kind(const fastdds::LivelinessQosPolicy& stated) {
  if (stated.lease_duration == eprosima::fastrtps::c_TimeInfinite) return LivelinessKind::endless;
  switch (stated.kind) {
    case fastdds::AUTOMATIC_LIVELINESS_QOS:
      break;
    case fastdds::MANUAL_BY_PARTICIPANT_LIVELINESS_QOS:
      return LivelinessKind::manual_by_participant;
    case fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS:
      return LivelinessKind::manual_by_topic;
  }
  return LivelinessKind::automatic;
}

WriterStatement statement_of(const eprosima::fastrtps::rtps::WriterProxyData& writer, bool command) {
  WriterStatement out;
  out.strength = static_cast<std::int32_t>(writer.m_qos.m_ownershipStrength.value);
  out.kind = to_kind(writer.m_qos.m_liveliness);
  out.where = where(writer);
  const bool shared = writer.m_qos.m_ownership.kind == fastdds::SHARED_OWNERSHIP_QOS;
  if (shared) out.strength = 0;
  out.lease.topic = !command ? CommandTopic::object : shared ? CommandTopic::shared_command : CommandTopic::command;
  const auto& lease = writer.m_qos.m_liveliness.lease_duration;
  if (is_sign_of_life(out.kind)) out.lease.length = lease.seconds * kSecond + lease.nanosec;
  return out;
}

}  // namespace

void WriterDiscovery::on_publisher_discovery(fastdds::DomainParticipant* participant, WriterDiscoveryInfo&& info) {
  const auto& data = info.info;
  if (data.guid().guidPrefix == participant->guid().guidPrefix) return;  // the library tells of our own as well
  const Guid writer = to_guid(data.guid());
  const bool removed = info.status == WriterDiscoveryInfo::REMOVED_WRITER;
  const bool command = data.topicName() == kCommandTopicName;
  if (command || data.topicName() == kObjectTopicName) {
    if (removed) {
      commanders_.on_removed(writer);
    } else {
      commanders_.on_discovered(writer, statement_of(data, command));
    }
  } else if (data.topicName() == kStateTopicName) {
    if (removed) {
      namesakes_.on_removed(writer);
    } else {
      const auto& key = data.m_qos.m_userData;
      namesakes_.on_discovered(writer, {key.begin(), key.end()}, where(data));
    }
  } else {
    return;
  }
  wake_.set();
}

}  // namespace axisgate::dds
