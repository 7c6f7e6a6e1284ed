// SPDX-License-Identifier: Apache-2.0
// The QoS of the topics that go out.
// Promises that a lost packet is noticed within kHeartbeatPeriod: the library's 3 s would throttle a full history.
// Never shares data with readers' memory, which not all makers can.
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>

namespace axisgate::dds {

inline const eprosima::fastrtps::Duration_t kHeartbeatPeriod(0, 20'000'000);
inline const eprosima::fastrtps::Duration_t kMostBlocking(0, 1'000'000);

/// Reliable, the newest `depth` samples of each instance.
[[nodiscard]] inline eprosima::fastdds::dds::DataWriterQos writer_qos(std::int32_t depth, std::int32_t instances,
                                                                      bool transient_local) {
  namespace fdds = eprosima::fastdds::dds;
  fdds::DataWriterQos qos;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = kMostBlocking;
  qos.durability().kind = transient_local ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
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

}  // namespace axisgate::dds
