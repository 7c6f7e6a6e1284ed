// SPDX-License-Identifier: Apache-2.0
// The DataWriters of our own topics that go out, with the QoS that design section 4 states for each.
// Promises that publishing waits for no reader: the newest samples of an instance take the place of older ones.
// Never reads anything, and never disposes an instance: a drive that is gone is shown by its link_state.
#pragma once

#include <algorithm>

#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/dds_process/publish/reply_writer.hpp"
#include "gateway/upstream/dds_process/topics/to_idl.hpp"

namespace axisgate::dds {

class Publishers {
 public:
  Publishers(Participant& participant, const GatewayId& gateway, program::Wake& wake);

  /// False: the record is none of those that go out.
  bool publish(const Record& record, SteadyNs now, ClockDifference difference);
  /// Replies that have waited for their clients' readers.
  void publish_held(SteadyNs now);
  /// When publish_held() has more, whatever happens.
  [[nodiscard]] SteadyNs due() const { return std::min(command_reply_.due(), object_reply_.due()); }

 private:
  GatewayId gateway_;
  fastdds::DataWriter& axis_state_;
  fastdds::DataWriter& axis_event_;
  fastdds::DataWriter& gateway_state_;
  ReplyWriter command_reply_;
  ReplyWriter object_reply_;
};

}  // namespace axisgate::dds
