// SPDX-License-Identifier: Apache-2.0
// What a bus counts about itself, as registers 50000 + 100 * b show it (design 3.1).
// Promises that counters only grow (modulo 2^32) between two starts of the gateway.
// Never used to decide anything.
#pragma once

#include <cstdint>

namespace axisgate::bus {

struct Statistics {
  std::uint32_t requests = 0;  ///< exchanges sent
  std::uint32_t replies = 0;   ///< exchanges answered, errors included
  std::uint32_t timeouts = 0;
  std::uint32_t bad_frames = 0;     ///< well-summed frames that fit nothing, ill-summed ones, wrong widths
  std::uint32_t late_replies = 0;   ///< well-formed replies to an exchange that was given up
  std::uint32_t dropped_bytes = 0;  ///< bytes skipped while looking for a frame, glitches among them
  std::uint32_t refused = 0;        ///< bus jobs refused because a queue was full
  std::uint32_t coalesced = 0;      ///< reads that joined an identical waiting one
  std::uint32_t superseded = 0;     ///< setpoints replaced before they were sent
  std::uint32_t reconnects = 0;     ///< times the link came back
  std::uint32_t echoes = 0;         ///< copies of our own requests that came back and were dropped

  friend bool operator==(const Statistics&, const Statistics&) = default;
  friend Statistics operator+(Statistics a, const Statistics& b) {
    a.requests += b.requests;
    a.replies += b.replies;
    a.timeouts += b.timeouts;
    a.bad_frames += b.bad_frames;
    a.late_replies += b.late_replies;
    a.dropped_bytes += b.dropped_bytes;
    a.refused += b.refused;
    a.coalesced += b.coalesced;
    a.superseded += b.superseded;
    a.reconnects += b.reconnects;
    a.echoes += b.echoes;
    return a;
  }
};

}  // namespace axisgate::bus
