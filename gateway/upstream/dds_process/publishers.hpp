// SPDX-License-Identifier: Apache-2.0
// The DataWriters of our own topics that go out, with the QoS that design section 4 states for each.
// Promises that publishing waits for no reader: the newest samples of an instance take the place of older ones.
// Never reads anything, and never disposes an instance: a drive that is gone is told by its link_state.
#pragma once

#include "gateway/upstream/dds_process/participant.hpp"
#include "gateway/upstream/dds_process/to_idl.hpp"

namespace axisgate::dds {

class Publishers {
 public:
  Publishers(Participant& participant, const GatewayId& gateway);

  /// False: the record is none of those that go out.
  bool publish(const Record& record, SteadyNs now, ClockDifference difference);

 private:
  GatewayId gateway_;
  fastdds::DataWriter& axis_state_;
  fastdds::DataWriter& axis_event_;
  fastdds::DataWriter& gateway_state_;
  fastdds::DataWriter& command_reply_;
  fastdds::DataWriter& object_reply_;
};

}  // namespace axisgate::dds
