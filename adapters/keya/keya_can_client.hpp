// SPDX-License-Identifier: Apache-2.0
// The requests of one Keya CAN bus: one outstanding, and what became of those before.
// Promises that a reply ends only the exchange that asked for it, and that a second reply to a finished one is
// reported. Never sends, and never looks at a clock.
#pragma once

#include <array>
#include <optional>

#include "adapters/keya/keya_can_exchange.hpp"

namespace axisgate::keya {

class CanClient {
 public:
  /// A second reply that comes within two of `timeout` is another device's.
  explicit CanClient(Duration timeout) : duplicate_window_(2 * timeout) {}

  /// Only while nothing is outstanding, and where refusal_of() has no value. To send.
  [[nodiscard]] CanMessage begin(const bus::Exchange& exchange);

  struct Heard {
    enum class What : std::uint8_t {
      mine,          ///< `result` is the answer to what was outstanding
      late,          ///< a reply to nothing that is waited for
      second_reply,  ///< a second reply to a request that is finished
      bad,           ///< no reply
    };
    What what = What::bad;
    bus::ExchangeResult result{};
  };
  /// What came under the reply id of `node`.
  [[nodiscard]] Heard take(std::uint8_t node, Bytes bytes, Instant now);

  /// The exchange outstanding timed out.
  void abandon();
  /// The link is lost.
  void reset();

 private:
  struct Finished {
    bus::Exchange exchange;
    Instant at;
  };
  struct Drive {
    std::optional<Finished> finished{};
    std::uint8_t owed = 0;  ///< replies to requests that were given up
  };
  [[nodiscard]] Heard not_mine(Drive& drive, const CanMessage& message, Instant now) const;

  Duration duplicate_window_;
  std::array<Drive, 256> drives_;
  std::optional<bus::Exchange> outstanding_;
};

}  // namespace axisgate::keya
