// SPDX-License-Identifier: Apache-2.0
// Which requests were seen lately, of each DDS writer: so that one that comes again is not run again, and its result is
// answered once more.
// Promises that a request stays known for kRequestsKept after it came last; that memory is bounded, and where it is
// full it says so instead of forgetting; that no writer can take the room of the others. Never knows what a request
// asks for.
#pragma once

#include <list>
#include <map>
#include <optional>
#include <unordered_map>

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

struct RequestKey {
  Guid writer{};
  AxisNumber axis = 0;
  std::uint64_t request_id = 0;
  friend auto operator<=>(const RequestKey&, const RequestKey&) = default;
};

/// How many requests are known at one time. Each takes about 120 bytes: 32 MB where all is full.
struct RequestBounds {
  std::size_t of_a_writer = 65'536;  ///< 64 axes at 100 Hz for 10 s
  std::size_t sure = 512;            ///< of a writer, however much the others have: one axis at 50 Hz
  std::size_t writers = 256;         ///< beyond, no request of another one is known
  std::size_t common = 131'072;      ///< of all writers together, beyond what each has for sure: more than one can take
};

class RequestMemory {
 public:
  RequestMemory(const RequestBounds& bounds, Duration kept) : bounds_(bounds), kept_(kept) {}

  enum class Known : std::uint8_t { first, again, full };
  struct Seen {
    Known known = Known::first;
    std::uint8_t command = 0;  ///< again: of the one that came first, or last acted
    bool newest = true;        ///< again: nothing else of this writer was seen for the axis since
    std::uint8_t result = 0;   ///< again: 0 as long as it has not ended
  };
  /// Remembers it, unless there is no room.
  [[nodiscard]] Seen see(const RequestKey& key, std::uint8_t command, Instant now);
  /// One that was seen acts after all, as another command.
  void acts(const RequestKey& key, std::uint8_t command);
  /// It has its result, unless it was another command that had this id last.
  void ended(const RequestKey& key, std::uint8_t command, std::uint8_t result);

  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Request {
    AxisNumber axis = 0;
    std::uint64_t id = 0;
    friend bool operator==(const Request&, const Request&) = default;
  };
  struct Hash {
    std::size_t operator()(const Request& request) const {
      constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio: spreads numbers that count up
      return static_cast<std::size_t>((request.id ^ (std::uint64_t{request.axis} << 48U)) * kOdd);
    }
  };
  struct Writer;
  using Writers = std::map<Guid, Writer>;
  struct Entry {
    Writers::iterator writer;
    Request request;
    Instant at;
    std::uint8_t command;
    std::uint8_t result;
  };
  using Entries = std::list<Entry>;
  struct Writer {
    std::unordered_map<Request, Entries::iterator, Hash> requests{};
    std::map<AxisNumber, std::uint64_t> newest{};  ///< the id that was seen last
  };
  void forget_old(Instant now);
  [[nodiscard]] Entry* find(const RequestKey& key);
  [[nodiscard]] bool has_room(const Guid& writer) const;

  RequestBounds bounds_;
  Duration kept_;
  Writers writers_;
  Entries entries_;         ///< the one that came last is the last
  std::size_t common_ = 0;  ///< beyond what each writer has for sure
};

}  // namespace axisgate::dds
