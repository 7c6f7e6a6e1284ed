// SPDX-License-Identifier: Apache-2.0
// What the drives of a line saw and sent: one entry per request that reached a drive, tied together by its tag.
// Promises a bound: the oldest entries go first.
// Never alters what it records.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "tests/simulated/rtu_frame.hpp"
#include "tests/simulated/ten_byte_frame.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

template <class Request>
struct ExchangeOf {
  std::uint64_t tag = 0;  // 1, 2, 3, ... per line
  Time received{};
  std::uint8_t station = 0;  // of the drive that heard it
  Request request{};
  Time reply_ready{};              // when the drive began to send
  std::vector<std::uint8_t> sent;  // what it put on the wire, faults included; empty if it did not answer
};

template <class Request>
class JournalOf {
 public:
  explicit JournalOf(std::size_t capacity) : capacity_(capacity) {}

  void record(ExchangeOf<Request> exchange) {
    ++recorded_;
    if (capacity_ == 0) return;
    if (entries_.size() == capacity_) entries_.pop_front();
    entries_.push_back(std::move(exchange));
  }
  const std::deque<ExchangeOf<Request>>& entries() const { return entries_; }
  std::uint64_t recorded() const { return recorded_; }

 private:
  std::size_t capacity_;
  std::deque<ExchangeOf<Request>> entries_;
  std::uint64_t recorded_ = 0;
};

using Exchange = ExchangeOf<TenByteFrame>;
using Journal = JournalOf<TenByteFrame>;

// `request` and `sent` are whole frames with their CRC. The reply tells what the drive held at `received`.
using RtuExchange = ExchangeOf<RtuBytes>;
using RtuJournal = JournalOf<RtuBytes>;

}  // namespace axisgate::simulated
