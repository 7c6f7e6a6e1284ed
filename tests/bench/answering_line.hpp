// SPDX-License-Identifier: Apache-2.0
// The simulated Kinco JD drives of one line, on either protocol, with as little between a request and its answer as
// possible. Promises the answers of tests/simulated, one for each whole request. Never waits, and never sends.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tests/bench/exchange_tap.hpp"
#include "tests/bench/line_protocol.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::bench {

struct Answer {
  TappedExchange exchange;  ///< without its times and line
  std::vector<std::uint8_t> bytes;
};

class AnsweringLine {
 public:
  AnsweringLine() = default;
  AnsweringLine(const AnsweringLine&) = delete;
  AnsweringLine& operator=(const AnsweringLine&) = delete;
  virtual ~AnsweringLine() = default;
  /// Of the last whole request among the bytes; `mute`: the station that hears and answers nothing, 0 for none.
  virtual std::optional<Answer> hear(std::span<const std::uint8_t> bytes, std::uint8_t mute, simulated::Time now) = 0;
  /// What is sent at once, whatever answer waits: an adapter's acknowledgements, what a node says by itself.
  virtual std::vector<std::uint8_t> unasked(simulated::Time /*now*/) { return {}; }
  /// The motor of the first drive has turned so far, at once: told by process data, where there are any.
  [[nodiscard]] virtual std::vector<std::uint8_t> turned(int /*turns*/) { return {}; }
};

/// Stations 1 to `drives`.
[[nodiscard]] std::unique_ptr<AnsweringLine> make_answering_line(LineProtocol protocol, int drives,
                                                                 simulated::Time now);

/// Of CAN alone, which make_answering_line() makes as well.
[[nodiscard]] std::unique_ptr<AnsweringLine> make_answering_can(LineProtocol protocol, int drives, simulated::Time now);

}  // namespace axisgate::bench
