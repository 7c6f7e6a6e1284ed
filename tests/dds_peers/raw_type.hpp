// SPDX-License-Identifier: Apache-2.0
// A Fast DDS type whose samples are the CDR bytes of another type, as they are on the wire.
// Promises that what was received is shown whole, encapsulation header included, and that what is given is sent as it
// is. Never understands a byte of it.
#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace axisgate::dds_peers {

struct RawSample {
  std::vector<std::uint8_t> payload;
};

class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
  static constexpr std::uint32_t kMaxPayload = 64 * 1024;
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  /// `name`: of the type it stands for, and whether that one has a key.
  RawType(const std::string& name, bool keyed) {
    setName(name.c_str());
    m_typeSize = kMaxPayload;
    m_isGetKeyDefined = keyed;
  }

  bool serialize(void* data, Payload* payload) override {
    const auto& bytes = static_cast<RawSample*>(data)->payload;
    std::copy(bytes.begin(), bytes.end(), payload->data);
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(Payload* payload, void* data) override {
    static_cast<RawSample*>(data)->payload.assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<RawSample*>(data)->payload.size()); };
  }
  void* createData() override { return new RawSample; }
  void deleteData(void* data) override { delete static_cast<RawSample*>(data); }
  /// All samples are of one instance: its key is not known here.
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool) override {
    *handle = eprosima::fastrtps::rtps::InstanceHandle_t();
    handle->value[0] = 1;
    return true;
  }
};

}  // namespace axisgate::dds_peers
