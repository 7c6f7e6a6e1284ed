// SPDX-License-Identifier: Apache-2.0
// One accepted socket: carries bytes between a client and its Session, and does what the Session says.
// Promises bounded memory and bounded work per turn of the loop, so that a client that floods or stalls costs the
// others nothing, and that its session outlives no stop(). Never looks into a byte it carries.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>
#include <string_view>

#include "gateway/upstream/modbus_tcp/session/session.hpp"

namespace axisgate::modbus_tcp {

/// What one turn reads at most: some twenty ordinary requests, or one of the largest. It bounds what a turn writes,
/// too.
inline constexpr std::size_t kReadPerTurn = kMaxAdu;

/// Not the type-erased executor of tcp::socket: it costs a few percent of each request.
using ClientSocket = boost::asio::basic_stream_socket<boost::asio::ip::tcp, boost::asio::io_context::executor_type>;

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// `on_closed` is called once, when the connection has ended by itself (never by stop()); it must not destroy it in
  /// there.
  Connection(ClientSocket socket, Runtime& runtime, const SessionContext& context, const Peer& peer,
             std::function<void(Connection&)> on_closed);

  void start();
  /// The server ends it: no handler touches the session, the runtime or anything shared after this.
  void stop();

  [[nodiscard]] const Peer& peer() const { return peer_; }
  [[nodiscard]] ClientId client() const { return session_->client(); }
  /// After the end: why the session gave up; none where the peer left.
  [[nodiscard]] CloseReason why_closed() const { return why_closed_; }
  /// Its place in its listener's table, kept by the listener.
  std::size_t place = 0;

 private:
  void read_soon();
  void on_read(const boost::system::error_code& error, std::size_t bytes);
  /// When the client's newest byte came to this machine.
  [[nodiscard]] Instant heard_last(Instant now);
  void on_deadline();
  void take_turn_soon();
  void take_turn(Instant now);
  void write_some(Instant now);
  void arm_timer();
  void end(CloseReason why);

  ClientSocket socket_;
  Runtime& runtime_;
  Peer peer_;
  std::function<void(Connection&)> on_closed_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<Timer> timer_;
  Instant armed_ = kNever;
  CloseReason why_closed_ = CloseReason::none;
  bool reading_ = false;
  bool waiting_to_write_ = false;
  bool turn_posted_ = false;
  bool ended_ = false;
  std::array<Byte, kReadPerTurn> incoming_;
};

}  // namespace axisgate::modbus_tcp
