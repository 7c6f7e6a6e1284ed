// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/listener.hpp"

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/socket_base.hpp>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "gateway/core/line_bucket.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

namespace axisgate::modbus_tcp {

namespace ip = boost::asio::ip;
using boost::system::error_code;

namespace {

/// A dead peer is noticed after 10 s of silence and three unanswered probes; what it has not acknowledged dies with it.
constexpr int kKeepIdleSeconds = 10;
constexpr int kKeepIntervalSeconds = 5;
constexpr int kKeepProbes = 3;
constexpr int kUserTimeoutMs = 1000 * (kKeepIdleSeconds + kKeepIntervalSeconds * kKeepProbes);

void set_option(int descriptor, int level, int name, int value) {
  // An option the kernel lacks costs comfort, not correctness: the session's own deadlines stand.
  static_cast<void>(::setsockopt(descriptor, level, name, &value, sizeof value));
}

void set_client_options(int descriptor) {
  set_option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(descriptor, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPIDLE, kKeepIdleSeconds);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPINTVL, kKeepIntervalSeconds);
  set_option(descriptor, IPPROTO_TCP, TCP_KEEPCNT, kKeepProbes);
  set_option(descriptor, IPPROTO_TCP, TCP_USER_TIMEOUT, kUserTimeoutMs);
}

Address address_of(const ip::address& from) {
  if (from.is_v6()) return from.to_v6().to_bytes();
  return ip::make_address_v6(ip::v4_mapped, from.to_v4()).to_bytes();
}

/// An interface may get its address, or be there at all, after us.
bool comes_late(const error_code& error) { return error.value() == EADDRNOTAVAIL || error.value() == ENODEV; }

std::string remedy(const error_code& error) {
  if (error == boost::asio::error::address_in_use)
    return "; another program has it: stop that one or choose another port";
  if (error == boost::asio::error::access_denied) {
    return "; ports below 1024 need root or CAP_NET_BIND_SERVICE: choose 1502, or grant it (setcap "
           "cap_net_bind_service=+ep "
           "PROGRAM; systemd: AmbientCapabilities=CAP_NET_BIND_SERVICE)";
  }
  if (comes_late(error)) return "; no interface of this computer has this address (0.0.0.0 means all)";
  if (error.value() == EAFNOSUPPORT) return "; this system has no IPv6: write an IPv4 address";
  return {};
}

bool out_of_resources(int error) { return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM; }

}  // namespace

Listener::Listener(ServerContext& server, const ListenerSettings& settings, std::size_t position)
    : server_(server),
      settings_(settings),
      session_context_{settings_, server.image, server.commands, server.clients, server.log, &server.runtime},
      position_(position),
      port_(settings.port),
      acceptor_(server.io) {}

std::string Listener::name() const { return address_text(settings_.host, port_); }

std::string Listener::in_vain(const error_code& error) const {
  return "/modbus_tcp/" + std::to_string(position_) + "/listen: cannot listen on " + name() + ": " + error.message() +
         remedy(error);
}

error_code Listener::bind() {
  error_code error;
  const ip::tcp::endpoint endpoint(
      ip::make_address(settings_.host == "localhost" ? "127.0.0.1" : settings_.host, error), settings_.port);
  if (!error) acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(boost::asio::socket_base::reuse_address(true), error);
  if (!error && endpoint.address().is_v6()) acceptor_.set_option(boost::asio::ip::v6_only(false), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
  if (!error) acceptor_.native_non_blocking(true, error);
  if (!error) port_ = acceptor_.local_endpoint(error).port();
  error_code ignored;
  if (error) acceptor_.close(ignored);
  return error;
}

void Listener::open() {
  error_code error;
  static_cast<void>(ip::make_address(settings_.host == "localhost" ? "127.0.0.1" : settings_.host, error));
  if (error) {
    throw std::runtime_error("/modbus_tcp/" + std::to_string(position_) + "/listen: cannot listen on " + name() +
                             ": not an IP address; write 0.0.0.0, 127.0.0.1 or an interface's address");
  }
  error = bind();
  if (error && !comes_late(error)) throw std::runtime_error(in_vain(error));
}

// Whatever stands against it by then: clients of the other listeners are served.
void Listener::try_address() {
  const error_code error = bind();
  if (!error) {
    refused_.clear();
    wait_for_client();
    return on_listening_();
  }
  if (error != std::exchange(refused_, error) && server_.reports.event)
    server_.reports.event(EventKind::warning, in_vain(error) + "; trying again each second");
  resume_->expires_at(server_.runtime.now() + kAddressPause);
}

void Listener::take_socket(Listener& other) {
  error_code ignored;
  other.acceptor_.cancel(ignored);  // its wait ends as cancelled, and stop() follows before that is heard
  acceptor_ = std::move(other.acceptor_);
  port_ = other.port_;
}

bool Listener::serves(ClientId client) const {
  return std::ranges::any_of(open_, [&](const auto& each) { return each->client() == client; });
}

void Listener::start(OnListening on_listening) {
  on_listening_ = std::move(on_listening);
  resume_ = server_.runtime.make_timer([this] { listens() ? wait_for_client() : try_address(); });
  listens() ? wait_for_client() : try_address();
}

void Listener::stop() {
  if (stopped_) return;
  stopped_ = true;
  resume_.reset();
  error_code ignored;
  acceptor_.close(ignored);
  server_.counters.open -= static_cast<std::uint32_t>(open_.size());
  for (const auto& connection : open_) connection->stop();
  for (const auto& connection : closed_) connection->stop();
  open_.clear();
  closed_.clear();
}

void Listener::wait_for_client() {
  acceptor_.async_wait(ip::tcp::acceptor::wait_read, [self = shared_from_this()](const error_code& error) {
    if (self->stopped_) return;
    if (error) return self->pause(error.value());
    self->accept_waiting();
  });
}

void Listener::accept_waiting() {
  for (int accepted = 0; accepted < kAcceptsPerTurn; ++accepted) {
    ip::tcp::endpoint from;
    socklen_t length = static_cast<socklen_t>(from.capacity());
    const int descriptor = ::accept4(acceptor_.native_handle(), from.data(), &length, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) break;
      if (out_of_resources(errno)) return pause(errno);
      continue;  // this one client left before it was accepted (ECONNABORTED and the like)
    }
    from.resize(length);
    admit(descriptor, from);
  }
  wait_for_client();
}

void Listener::pause(int why) {
  ++server_.counters.accept_pauses;
  if (const auto left_out = pauses_logged_.admit(server_.runtime.now())) {
    server_.log.write(
        LogLevel::error, "modbus",
        name() + ": cannot accept: " + std::strerror(why) + "; new clients wait" + left_out_text(*left_out));
  }
  resume_->expires_at(server_.runtime.now() + kAcceptPause);
}

void Listener::admit(int descriptor, const ip::tcp::endpoint& from) {
  const Address address = address_of(from.address());
  const Role role = role_of(settings_, address);
  const std::uint32_t others = server_.counters.open - counts_.total();
  const std::uint32_t room = server_.descriptors.max_clients > others ? server_.descriptors.max_clients - others : 0;
  const ConnectionVerdict verdict = counts_.admit(settings_, address, role, room);
  if (verdict != ConnectionVerdict::admitted) {
    ::close(descriptor);
    return refuse(verdict, address);
  }
  if (server_.descriptors.move_up) descriptor = moved_up(descriptor);
  if (descriptor < 0) {
    counts_.release(address);
    return refuse(ConnectionVerdict::no_descriptor, address);
  }
  set_client_options(descriptor);
  ClientSocket socket(server_.io);
  error_code error;
  socket.assign(acceptor_.local_endpoint(error).protocol(), descriptor, error);
  if (!error) socket.non_blocking(true, error);
  if (error) {
    if (!socket.is_open()) ::close(descriptor);
    counts_.release(address);
    return refuse(ConnectionVerdict::no_descriptor, address);
  }
  ++server_.counters.accepted;
  ++server_.counters.open;
  const Peer peer{address, from.port(), role, rank_of(settings_, address)};
  auto connection = std::make_shared<Connection>(std::move(socket), server_.runtime, session_context_, peer,
                                                 [this](Connection& closed) { on_closed(closed); });
  connection->place = open_.size();
  open_.push_back(connection);
  connection->start();
}

void Listener::refuse(ConnectionVerdict why, const Address& address) {
  ++(why == ConnectionVerdict::not_allowed ? server_.counters.refused_not_allowed : server_.counters.refused_full);
  if (const auto left_out = refusals_logged_.admit(server_.runtime.now())) {
    server_.log.write(LogLevel::warning, "modbus",
                      name() + " refused " + modbus_tcp::text(address) + ": " + modbus_tcp::text(why, settings_) +
                          left_out_text(*left_out));
  }
}

void Listener::on_closed(Connection& connection) {
  const CloseReason why = connection.why_closed();
  if (why == CloseReason::none) {
    ++server_.counters.closed_by_peer;
  } else if (why == CloseReason::malformed) {
    // Counted apart: it tells of a wrong client and not of a bad line.
    ++server_.counters.closed_malformed;
    if (const auto left_out = malformed_logged_.admit(server_.runtime.now())) {
      server_.log.write(LogLevel::warning, "modbus",
                        name() + " closed " + modbus_tcp::text(connection.peer().address) + ": " +
                            std::string(modbus_tcp::text(why)) + left_out_text(*left_out));
    }
  } else {
    ++server_.counters.closed_late;
  }
  if (server_.log.wants(LogLevel::debug)) {
    server_.log.write(LogLevel::debug, "modbus " + modbus_tcp::text(connection.peer()), modbus_tcp::text(why));
  }
  --server_.counters.open;
  counts_.release(connection.peer().address);
  if (closed_.empty()) {
    boost::asio::post(server_.io, [self = shared_from_this()] { self->drop_closed(); });
  }
  const std::size_t place = connection.place;
  closed_.push_back(std::move(open_[place]));
  if (place + 1 != open_.size()) {
    open_[place] = std::move(open_.back());
    open_[place]->place = place;
  }
  open_.pop_back();
}

void Listener::drop_closed() {
  for (const auto& connection : closed_) connection->stop();
  closed_.clear();
}

}  // namespace axisgate::modbus_tcp
