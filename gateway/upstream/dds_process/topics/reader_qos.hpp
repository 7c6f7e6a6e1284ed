// SPDX-License-Identifier: Apache-2.0
// The QoS of the topics that come in.
// Promises room for so many instances and samples that no flood takes more memory, and none that is taken beforehand.
// Never shares data with writers' memory, which not all makers can.
#pragma once

#include <cstdint>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

namespace axisgate::dds {

/// Volatile, the newest sample of each instance.
[[nodiscard]] inline eprosima::fastdds::dds::DataReaderQos reader_qos(bool reliable, std::int32_t instances,
                                                                      std::int32_t samples_per_instance) {
  namespace fdds = eprosima::fastdds::dds;
  fdds::DataReaderQos qos;
  qos.reliability().kind = reliable ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.resource_limits().max_instances = instances;
  qos.resource_limits().max_samples_per_instance = samples_per_instance;
  qos.resource_limits().max_samples = instances * samples_per_instance;
  qos.resource_limits().allocated_samples = 0;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

}  // namespace axisgate::dds
