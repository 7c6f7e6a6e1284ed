// SPDX-License-Identifier: Apache-2.0
// The topics that are read: names, types, and the part of their QoS that decides who is matched.
// Promises the same answers to all readers of one topic.
// Never makes a reader.
#pragma once

#include <axisgatePubSubTypes.h>

#include <algorithm>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "gateway/upstream/dds_link/guid.hpp"
#include "gateway/upstream/dds_process/topics/guarded_type.hpp"
#include "gateway/upstream/dds_process/topics/reader_qos.hpp"

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
  return reader_qos(true, kMostInstances, samples_per_instance);
}

[[nodiscard]] inline Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid bytes{};
  auto at = std::copy_n(guid.guidPrefix.value, guid.guidPrefix.size, bytes.begin());
  std::copy_n(guid.entityId.value, guid.entityId.size, at);
  return bytes;
}

}  // namespace axisgate::dds
