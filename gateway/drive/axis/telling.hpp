// SPDX-License-Identifier: Apache-2.0
// Which of an axis's requests log and events tell of: each command once, a stream of set-points when it begins.
// Promises that no client can fill log or events: what is asked or refused again and again is logged once a minute, all
// else by a bucket for each kind, and each line counts what was left out. Never waits, and costs a request that is not
// logged no more than a look at a short list.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "gateway/core/error.hpp"
#include "gateway/core/line_bucket.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

/// What is asked again within this time is the same stream.
inline constexpr Duration kStreamPause = std::chrono::seconds(2);
/// The same for what is refused: programs that try again wait longer.
inline constexpr Duration kRefusalPause = std::chrono::seconds(10);
/// A stream that goes on is logged again after so long.
inline constexpr Duration kStreamRepeat = std::chrono::seconds(60);
/// Streams of one axis that are distinguished; the one that was silent for longest makes way.
inline constexpr std::size_t kMaxStreams = 8;

class Telling {
 public:
  /// What makes two requests the same for whoever reads of them.
  struct Request {
    ClientId client = 0;
    Errc refused = Errc::ok;
    Command command = Command::none;
    std::uint32_t quantities = 0;  ///< bits of what is set, controlword and mode too
    std::uint32_t object = 0;      ///< of the mailbox or 43/13: index and sub-index
    friend bool operator==(const Request&, const Request&) = default;
  };

  /// A request is to be logged, with what was left out since the last such line; none: it is left out as well.
  [[nodiscard]] std::optional<std::uint64_t> asked(const WriteBatch& batch, Instant now);
  /// Who owns the axis has changed: one-shot tools do it with each connection.
  [[nodiscard]] std::optional<std::uint64_t> owner(Instant now);
  [[nodiscard]] std::optional<std::uint64_t> refused(const WriteBatch& batch, Errc code, Instant now);

 private:
  struct Stream {
    Request request{};
    Instant newest = kLongAgo;
    Instant logged_at = kLongAgo;
    std::uint64_t left_out = 0;
  };
  [[nodiscard]] std::optional<std::uint64_t> of_stream(const Request& request, Duration pause, LineBucket& bucket,
                                                       Instant now);

  boost::container::static_vector<Stream, kMaxStreams> streams_;
  LineBucket stops_;
  LineBucket commands_;
  LineBucket values_;
  LineBucket refusals_;
  LineBucket owners_;
};

[[nodiscard]] Telling::Request request_of(const WriteBatch& batch, Errc refused);

}  // namespace axisgate::drive
