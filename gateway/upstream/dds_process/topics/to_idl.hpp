// SPDX-License-Identifier: Apache-2.0
// Records of the link as the types of schemas/axisgate.idl, and requests of clients as records.
// Promises one for one translation: no value is judged, scaled or left out; what is longer than its IDL bound is cut.
// Never knows a topic, a socket or a clock: the two clocks' difference is given to it.
#pragma once

#include <axisgate.h>

#include <cstdint>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// CLOCK_REALTIME minus CLOCK_MONOTONIC, in nanoseconds.
using ClockDifference = std::int64_t;

/// Who has written a sample, and when (steady clock; 0: it does not say).
struct Sender {
  Guid writer{};
  std::int32_t strength = 0;
  SteadyNs written = 0;
  SteadyNs received = 0;
};

[[nodiscard]] axisgate::Time to_time(SteadyNs at, ClockDifference difference);

[[nodiscard]] axisgate::AxisState to_idl(const StateRecord& record, ClockDifference difference,
                                         const GatewayId& gateway);
[[nodiscard]] axisgate::AxisEvent to_idl(const EventRecord& record, ClockDifference difference,
                                         const GatewayId& gateway);
[[nodiscard]] axisgate::GatewayState to_idl(const GatewayRecord& record, SteadyNs now, ClockDifference difference,
                                            const GatewayId& gateway);
[[nodiscard]] axisgate::CommandReply to_idl(const ReplyRecord& record, const GatewayId& gateway);
[[nodiscard]] axisgate::ObjectReply to_idl(const ObjectReplyRecord& record, const GatewayId& gateway);

[[nodiscard]] CommandRecord to_record(const axisgate::AxisCommand& sample, const Sender& sender);
[[nodiscard]] ObjectRequestRecord to_record(const axisgate::ObjectRequest& sample, const Sender& sender);
[[nodiscard]] HeartbeatRecord to_record(const axisgate::Heartbeat& sample, const Sender& sender);

}  // namespace axisgate::dds
