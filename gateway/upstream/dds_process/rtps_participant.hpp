// SPDX-License-Identifier: Apache-2.0
// The participant of the readers of axis_command, which are made one layer below DDS (axis_command_reader.hpp): that
// layer does not let anybody add to a participant of DDS. Promises the network, the limits and the properties of that
// participant, DDS-Security's included. Never has a writer.
#pragma once

#include <fastdds/rtps/participant/RTPSParticipant.h>

#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

namespace axisgate::dds {

class RtpsParticipant {
 public:
  RtpsParticipant(std::uint32_t domain, const eprosima::fastdds::dds::DomainParticipantQos& qos);
  ~RtpsParticipant();
  RtpsParticipant(const RtpsParticipant&) = delete;
  RtpsParticipant& operator=(const RtpsParticipant&) = delete;

  [[nodiscard]] eprosima::fastrtps::rtps::RTPSParticipant& operator*() { return *participant_; }

 private:
  eprosima::fastrtps::rtps::RTPSParticipant* participant_;
};

}  // namespace axisgate::dds
