// SPDX-License-Identifier: Apache-2.0
// A generated type whose samples come from the network: bytes that are none of its samples are refused, whatever they
// are. Promises that no exception leaves deserialize(): the generated code lets those of Fast CDR for a bad
// encapsulation pass, and they would end the process. Never changes what a sound sample is read as.
#pragma once

#include <exception>
#include <fastdds/dds/topic/TopicDataType.hpp>

namespace axisgate::dds {

template <typename Generated>
class GuardedType final : public Generated {
 public:
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      return Generated::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;
    }
  }
};

}  // namespace axisgate::dds
