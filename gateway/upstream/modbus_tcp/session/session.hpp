// SPDX-License-Identifier: Apache-2.0
// One Modbus-TCP connection: bytes in, bytes out. Pure: no socket, no clock.
// Promises replies in request order, at most kMaxPipelined requests under way, a malformed frame closing the
// connection, and that a stop behind a slow write is started on arrival. Never waits for a bus in a read.
#pragma once

#include <boost/noncopyable.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/bytes.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/client/peer.hpp"
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

inline constexpr std::size_t kMaxPipelined = 4;
inline constexpr std::size_t kMaxAdu = 260;
/// A busy machine's turns come late as well: what has waited less than this has just come.
inline constexpr Duration kLongWait = std::chrono::seconds(2);

class ClientRegistry;
class Pipeline;
struct Client;

/// What all sessions of one listener share.
struct SessionContext {
  const ListenerSettings& settings;
  ProcessImage& image;
  CommandPort& commands;
  ClientRegistry& clients;
  const Log& log;
  /// The time of results that come from the bus, between two calls of the server. Without it the time of the last call
  /// counts, and ages in replies to slow writes are that much too small.
  const Runtime* runtime = nullptr;
};

/// Why a connection ends.
enum class CloseReason : std::uint8_t {
  none,                ///< it does not, or its client or the network has ended it
  malformed,           ///< an MBAP header that cannot be one: where the next request begins cannot be known
  request_incomplete,  ///< a request was begun, and its last byte did not come in time
  reply_not_taken,     ///< the client does not read
  idle,
};
/// "malformed frame"; of none: "closed by the client".
[[nodiscard]] std::string_view text(CloseReason why);

class Session : boost::noncopyable {
 public:
  /// `on_output` is called when output() has grown by something that was not caused by on_bytes() or on_deadline() just
  /// now (a write's result came from the bus), or when wants_input() or finished() changed with it.
  Session(const SessionContext& context, const Peer& peer, Instant now, std::function<void()> on_output);
  ~Session();

  /// Any split of the stream. Bytes beyond what is wanted now are kept (at most kMaxPipelined ADUs) and carried on
  /// later. `came`: when the newest of them came to this machine. What was there for kLongWait and more is a sign of
  /// life of then, and a write among it is not begun after start_deadline_ms, unless it asks for a stop.
  void on_bytes(Bytes bytes, Instant now, Instant came);
  void on_bytes(Bytes bytes, Instant now) { on_bytes(bytes, now, now); }
  void on_deadline(Instant now);
  /// The connection is gone: writes under way go on, their results are nobody's.
  void on_closed(Instant now);

  /// Reply bytes not yet taken. The server sends and calls take_output() with what it wrote.
  [[nodiscard]] Bytes output() const { return Bytes(output_).subspan(taken_); }
  void take_output(std::size_t bytes, Instant now);
  /// False while kMaxPipelined requests wait or a reply is not taken: the socket is not read then.
  [[nodiscard]] bool wants_input() const { return !over() && has_room() && output().empty(); }
  /// Close once output() is empty: malformed frame, deadline of a slow client, idle.
  [[nodiscard]] bool finished() const;
  [[nodiscard]] CloseReason why_finished() const { return why_; }
  [[nodiscard]] Instant next_deadline() const;
  [[nodiscard]] ClientId client() const;

 private:
  [[nodiscard]] bool over() const { return why_ != CloseReason::none || closed_; }
  [[nodiscard]] bool has_room() const;
  void name_rtu_client(Bytes first);
  void take_requests();
  void put_reply(std::uint16_t transaction, std::uint8_t unit, const Pdu& pdu);
  void on_result(std::uint64_t number, const Outcome& outcome);
  [[nodiscard]] Instant part_deadline() const;
  [[nodiscard]] Instant reply_deadline() const;
  [[nodiscard]] Instant idle_deadline() const;

  SessionContext context_;
  std::shared_ptr<Client> client_;
  std::function<void()> on_output_;
  MbapFramer framer_;
  std::unique_ptr<Pipeline> pipeline_;
  std::vector<Byte> output_;
  std::size_t taken_ = 0;            ///< bytes of output_
  std::size_t replies_waiting_ = 0;  ///< replies put into output_ since it was last empty
  Instant now_;                      ///< of the last call
  Instant came_ = kNever;            ///< at the latest, what was read last
  Instant part_since_ = kNever;      ///< first byte of a request that is not whole yet
  Instant reply_since_ = kNever;     ///< first byte of output_ that is not taken yet
  Instant active_at_;                ///< last whole request, or last reply taken
  CloseReason why_ = CloseReason::none;
  bool closed_ = false;
  bool is_new_ = true;  ///< nothing has come yet
};

}  // namespace axisgate::modbus_tcp
