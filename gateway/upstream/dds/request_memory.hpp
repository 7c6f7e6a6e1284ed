// SPDX-License-Identifier: Apache-2.0
// Which requests were seen lately, of all DDS writers together: so that one that comes again is not run again.
// Promises that a request stays known for kRequestsKept after it came last, and that memory is bounded: where it is
// full it says so instead of forgetting. Never knows what a request asks for.
#pragma once

#include <list>
#include <map>

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

struct RequestKey {
  Guid writer{};
  AxisNumber axis = 0;
  std::uint64_t request_id = 0;
  friend auto operator<=>(const RequestKey&, const RequestKey&) = default;
};

class RequestMemory {
 public:
  /// `most`: requests that are known at one time.
  RequestMemory(std::size_t most, Duration kept) : most_(most), kept_(kept) {}

  enum class Seen : std::uint8_t { first, again, full };
  /// Remembers it, unless there is no room.
  [[nodiscard]] Seen see(const RequestKey& key, Instant now);

 private:
  struct Entry {
    RequestKey key;
    Instant at;
  };

  std::size_t most_;
  Duration kept_;
  std::list<Entry> entries_;  ///< the one that came last is the last
  std::map<RequestKey, std::list<Entry>::iterator> known_;
};

}  // namespace axisgate::dds
