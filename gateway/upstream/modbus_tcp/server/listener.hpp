// SPDX-License-Identifier: Apache-2.0
// One listening socket and the connections it has accepted.
// Promises an honest refusal: who may not come in, or finds no room, is accepted and closed at once, counted, and named
// in the log at most once a minute; that an address which this computer does not have yet is tried each second. Never
// spins when the system is out of descriptors, and never accepts without bound in one turn.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/modbus_tcp/server/access.hpp"
#include "gateway/upstream/modbus_tcp/server/connection.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"
#include "gateway/upstream/modbus_tcp/server/server_counters.hpp"
#include "gateway/upstream/modbus_tcp/server/server_reports.hpp"

namespace axisgate::modbus_tcp {

inline constexpr int kAcceptsPerTurn = 16;
inline constexpr Duration kAcceptPause = std::chrono::milliseconds(200);
inline constexpr Duration kAddressPause = std::chrono::seconds(1);
inline constexpr Duration kRefusalLogInterval = std::chrono::minutes(1);

/// What all listeners of one server share; the server owns it.
struct ServerContext {
  boost::asio::io_context& io;
  Runtime& runtime;
  ProcessImage& image;
  CommandPort& commands;
  ClientRegistry& clients;
  const Log& log;
  ServerReports reports;
  DescriptorPlan descriptors;
  ServerCounters counters;
};

class Listener : public std::enable_shared_from_this<Listener> {
 public:
  Listener(ServerContext& server, const ListenerSettings& settings, std::size_t position);

  using OnListening = std::function<void()>;

  /// Binds and listens; "::" serves IPv4 as well. An address that no interface has yet is left to start(). Throws
  /// std::runtime_error that names the listener and what to change.
  void open();
  /// In place of open(): takes over the socket of a listener on the same address, with the clients that wait on it.
  /// That one has only its connections then, and can only be stopped.
  void take_socket(Listener& other);
  /// Where its address is not there yet, it is tried from now on, and `on_listening` is called once it is.
  void start(OnListening on_listening);
  /// It has its address.
  [[nodiscard]] bool listens() const { return acceptor_.is_open(); }
  /// Closes the socket and every connection; nothing of the server is touched after it.
  void stop();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const ListenerSettings& settings() const { return settings_; }
  /// One of its connections is this client's.
  [[nodiscard]] bool serves(ClientId client) const;
  /// "0.0.0.0:1502" with the port in force.
  [[nodiscard]] std::string name() const;

 private:
  /// What the system says against it; empty: it listens.
  [[nodiscard]] boost::system::error_code bind();
  [[nodiscard]] std::string in_vain(const boost::system::error_code& error) const;
  void try_address();
  void wait_for_client();
  void accept_waiting();
  void pause(int why);
  void admit(int descriptor, const boost::asio::ip::tcp::endpoint& from);
  void refuse(ConnectionVerdict why, const Address& address);
  void on_closed(Connection& connection);
  void drop_closed();

  ServerContext& server_;
  const ListenerSettings settings_;
  SessionContext session_context_;
  std::size_t position_;  ///< in the configuration, for messages
  std::uint16_t port_ = 0;
  boost::asio::ip::tcp::acceptor acceptor_;
  std::unique_ptr<Timer> resume_;
  OnListening on_listening_;
  boost::system::error_code refused_{};  ///< why it does not listen, as reported last
  ClientCounts counts_;
  std::vector<std::shared_ptr<Connection>> open_;
  std::vector<std::shared_ptr<Connection>>
      closed_;  ///< dropped in a turn of their own, never inside their own callbacks
  LineLimit refusals_logged_{kRefusalLogInterval};
  LineLimit malformed_logged_{kRefusalLogInterval};
  LineLimit pauses_logged_{kRefusalLogInterval};
  bool stopped_ = false;
};

}  // namespace axisgate::modbus_tcp
