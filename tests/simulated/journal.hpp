// What the drives of a line saw and sent: one entry per request that reached a drive, tied together by its tag.
// Promises a bound (the oldest entries go first) and a hash over all entries ever made, for "same seed, same run".
// Never alters what it records.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "tests/simulated/ten_byte_frame.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

struct Exchange {
  std::uint64_t tag = 0;  // 1, 2, 3, ... per line
  Time received{};
  std::uint8_t station = 0;  // of the drive that heard it
  TenByteFrame request{};
  Time reply_ready{};              // when the drive began to send
  std::vector<std::uint8_t> sent;  // what it put on the wire, faults included; empty if it did not answer
};

class Journal {
 public:
  explicit Journal(std::size_t capacity) : capacity_(capacity) {}

  void record(Exchange exchange);
  const std::deque<Exchange>& entries() const { return entries_; }
  std::uint64_t recorded() const { return recorded_; }
  std::uint64_t hash() const { return hash_; }

 private:
  void mix(std::uint64_t value);

  std::size_t capacity_;
  std::deque<Exchange> entries_;
  std::uint64_t recorded_ = 0;
  std::uint64_t hash_ = 0xCBF29CE484222325U;  // FNV-1a
};

}  // namespace axisgate::simulated
