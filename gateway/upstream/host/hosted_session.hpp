// SPDX-License-Identifier: Apache-2.0
// What is said to a program of the gateway's own and what is made of what it says, as its keeper sees it: packets.
// Promises nothing of when it is called: the keeper does. Never knows the process or its socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/upstream/link/coder.hpp"

namespace axisgate::host {

/// A packet of the program.
struct Heard {
  enum class What : std::uint8_t {
    nonsense,  ///< text: why it is no record that the program may send
    ready,     ///< text: its version
    line,      ///< text: for the gateway's log
    own,       ///< a record that only this program has
  };
  What what = What::nonsense;
  std::string text{};
  std::uint8_t level = 0;  ///< of a line, as LogLevel
};

inline constexpr const char* kOutOfItsTurn = "a record out of its turn";

/// Of a record variant in which the gateway's own come first, then Ready, Line and the program's own.
/// @param program its name, for the words
template <typename Ready, typename Line, typename Record>
[[nodiscard]] Heard heard(const link::Decoded<Record>& decoded, std::string_view program) {
  if (decoded.error != link::DecodeError::none) return {Heard::What::nonsense, link::text(decoded.error, program)};
  if (const auto* const line = std::get_if<Line>(&decoded.record)) return {Heard::What::line, line->text, line->level};
  if (const auto* const ready = std::get_if<Ready>(&decoded.record)) return {Heard::What::ready, ready->version};
  if (decoded.record.index() > Record(Ready{}).index()) return {Heard::What::own};
  return {Heard::What::nonsense, kOutOfItsTurn};
}

class HostedSession {
 public:
  HostedSession() = default;
  HostedSession(const HostedSession&) = delete;
  HostedSession& operator=(const HostedSession&) = delete;
  virtual ~HostedSession() = default;

  [[nodiscard]] virtual Heard hear(Bytes packet) = 0;
  /// The record of its own that was heard last counts.
  virtual void take(Instant /*now*/) {}
  /// One more record of its own can be taken: nothing is read before.
  [[nodiscard]] virtual bool has_room() const { return true; }

  /// The program is there and knows nothing yet.
  virtual void on_link_up(Instant now) = 0;
  /// It is gone: nothing is to be sent.
  virtual void on_link_down(Instant now) = 0;
  /// What is to be sent now. None: nothing before wake_at(), or before whoever has something wakes the keeper.
  [[nodiscard]] virtual std::optional<std::vector<Byte>> next(Instant now) = 0;
  [[nodiscard]] virtual Instant wake_at() const = 0;
  /// The socket has not taken the packet that next() gave: it is kept, and nothing is asked for until it has.
  virtual void on_no_room() {}
};

}  // namespace axisgate::host
