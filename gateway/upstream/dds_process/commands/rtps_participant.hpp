// SPDX-License-Identifier: Apache-2.0
// The participant of the readers of axis_command, which are made one layer below DDS (axis_command_reader.hpp): that
// layer does not let anybody add to a participant of DDS. Promises the network, the limits and the properties of that
// participant, DDS-Security's included, and that others hear of its readers in the order in which they were made. Never
// has a writer.
#pragma once

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>

#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"

namespace axisgate::dds {

/// Room for samples that wait for one before them that was lost, and memory for a usual one.
[[nodiscard]] eprosima::fastrtps::rtps::HistoryAttributes command_history();

class RtpsParticipant {
 public:
  RtpsParticipant(std::uint32_t domain, const eprosima::fastdds::dds::DomainParticipantQos& qos);
  ~RtpsParticipant();
  RtpsParticipant(const RtpsParticipant&) = delete;
  RtpsParticipant& operator=(const RtpsParticipant&) = delete;

  /// Of axis_command, reliable and volatile. What it announces is its ownership and, where one is asked for, the lease
  /// that its writers' MANUAL_BY_TOPIC liveliness must offer.
  [[nodiscard]] eprosima::fastrtps::rtps::RTPSReader& make_reader(const LivelinessLease& asked,
                                                                  eprosima::fastrtps::rtps::ReaderHistory& history,
                                                                  eprosima::fastrtps::rtps::ReaderListener& listener);
  static void end_reader(eprosima::fastrtps::rtps::RTPSReader& reader);

 private:
  eprosima::fastrtps::rtps::RTPSParticipant* participant_;
};

}  // namespace axisgate::dds
