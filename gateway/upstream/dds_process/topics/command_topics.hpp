// SPDX-License-Identifier: Apache-2.0
// The topics that are read: names, types, and the part of their QoS that decides who is matched.
// Promises the same answers to all readers of one topic.
// Never makes a reader.
#pragma once

#include <axisgatePubSubTypes.h>

#include <algorithm>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "gateway/upstream/dds_link/guid.hpp"
#include "gateway/upstream/dds_process/topics/guarded_type.hpp"

namespace axisgate::dds {

inline constexpr const char* kCommandTopicName = "axisgate/axis_command";
inline constexpr const char* kStateTopicName = "axisgate/axis_state";
inline constexpr const char* kGatewayTopicName = "axisgate/gateway_state";
inline constexpr const char* kHeartbeatTopicName = "axisgate/heartbeat";
inline constexpr const char* kObjectTopicName = "axisgate/object_request";
/// Any axis number may be asked for: one that does not exist is to be answered, not to block the others.
inline constexpr std::int32_t kMostInstances = 65536;

[[nodiscard]] inline eprosima::fastdds::dds::TypeSupport object_type() {
  return eprosima::fastdds::dds::TypeSupport(new GuardedType<ObjectRequestPubSubType>());
}

/// Of object_request: reliable, volatile.
[[nodiscard]] inline eprosima::fastdds::dds::DataReaderQos object_reader_qos(std::int32_t samples_per_instance) {
  namespace fdds = eprosima::fastdds::dds;
  fdds::DataReaderQos qos;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
  qos.resource_limits().max_instances = kMostInstances;
  qos.resource_limits().max_samples_per_instance = samples_per_instance;
  qos.resource_limits().max_samples = kMostInstances * samples_per_instance;
  qos.resource_limits().allocated_samples = 0;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

[[nodiscard]] inline Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid bytes{};
  auto at = std::copy_n(guid.guidPrefix.value, guid.guidPrefix.size, bytes.begin());
  std::copy_n(guid.entityId.value, guid.entityId.size, at);
  return bytes;
}

}  // namespace axisgate::dds
