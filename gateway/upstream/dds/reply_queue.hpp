// SPDX-License-Identifier: Apache-2.0
// Replies on their way to axisgate-dds: those that wait for the socket, and how many requests still have theirs to
// come. Promises that a request which was accepted finds room for its reply. Never holds more than its bound, whatever
// is asked by a process that does not read.
#pragma once

#include <deque>
#include <optional>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class ReplyQueue {
 public:
  /// `most`: accepted requests without a reply that was sent. Refusals may take as much again.
  explicit ReplyQueue(std::size_t most) : most_(most) {}

  /// One more request may be accepted.
  [[nodiscard]] bool admits() const { return waiting_.size() + outstanding_ < most_; }
  /// The reply to whatever comes next has a place.
  [[nodiscard]] bool has_room() const { return waiting_.size() + outstanding_ < 2 * most_; }

  /// A request whose reply comes later, and its end.
  void begin() { ++outstanding_; }
  void end() { --outstanding_; }

  /// Without room, or with nobody to read it, it is dropped: its request is known as already seen.
  void add(Record reply);
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::optional<Record> next();

  void open() { open_ = true; }
  void close();

 private:
  std::size_t most_;
  std::size_t outstanding_ = 0;
  std::deque<Record> waiting_;
  bool open_ = false;
};

}  // namespace axisgate::dds
