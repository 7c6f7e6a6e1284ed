// SPDX-License-Identifier: Apache-2.0
// The drives' way to the host: what they send, when its last byte arrives, one after the other on one pair of wires.
// Promises that each byte takes its time at the baud rate and that nothing overtakes. Never alters a byte.
#pragma once

#include <map>
#include <vector>

#include "tests/simulated/drive_line.hpp"

namespace axisgate::simulated {

struct Chunk {
  std::uint64_t tag;
  ByteOrigin origin;
  std::size_t drive;  // whose restart takes it away; the number of drives for an echo
  std::vector<std::uint8_t> bytes;
};

// 10 bits per byte (all sheets: 8N1); 0: bytes take no time.
Time byte_time(std::uint32_t baud, std::size_t bytes = 1);

class OutgoingWire {
 public:
  explicit OutgoingWire(std::uint32_t baud) : baud_(baud) {}

  void send(Time ready, Chunk chunk) { waiting_.emplace(std::pair{ready, ++chunks_}, std::move(chunk)); }
  // Of a drive, behind what its transceiver makes before it; tells when the reply itself begins.
  Time send_behind_glitch(Time ready, Chunk chunk, const DriveFaults& faults);
  std::optional<Time> next_event() const;
  bool arrives_at(Time at) const { return !arriving_.empty() && arriving_.begin()->first.first == at; }
  bool begins_at(Time at) const { return !waiting_.empty() && waiting_.begin()->first.first == at; }
  Chunk take_arrived() { return std::move(arriving_.extract(arriving_.begin()).mapped()); }
  void begin();  // the first that waits goes on the wire, when the wire is free
  void forget(std::size_t drive);
  void cut() { waiting_.clear(), arriving_.clear(); }

 private:
  using Queue = std::map<std::pair<Time, std::uint64_t>, Chunk>;

  std::uint32_t baud_;
  Queue waiting_;   // by the time the drive begins to send
  Queue arriving_;  // by the time the last byte is there
  Time free_at_{};
  std::uint64_t chunks_ = 0;
};

}  // namespace axisgate::simulated
