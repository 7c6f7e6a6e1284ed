// SPDX-License-Identifier: Apache-2.0
// The Modbus-TCP server: its listeners, opened together and stopped together, on the core thread's io_context.
// Promises that start() and prepare() throw, and say which address and what to change, where one is taken or not
// allowed; that one which no interface has yet is tried each second, while the others serve; that a listener which a
// reload keeps does not notice it; that nothing of it runs after stop(). Never decides what a request means: that is
// the Session's part.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/noncopyable.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"
#include "gateway/upstream/modbus_tcp/server/server_counters.hpp"
#include "gateway/upstream/modbus_tcp/server/server_reports.hpp"

namespace axisgate::modbus_tcp {

class ClientRegistry;
class Listener;
struct ServerContext;

class Server : boost::noncopyable {
 public:
  /// Copies the settings. Everything passed by reference must outlive the server.
  Server(boost::asio::io_context& io, Runtime& runtime, std::span<const ListenerSettings> listeners,
         ProcessImage& image, CommandPort& commands, ClientRegistry& clients, const Log& log,
         ServerReports reports = {});
  ~Server();

  /// Binds all listeners, then accepts as many clients as `descriptors` leaves room for (take_descriptors()). Throws
  /// std::runtime_error, and has then opened nothing.
  void start(const DescriptorPlan& descriptors);
  /// The first half of a reload: opens what of `wanted` has no listener on its address yet, and accepts nobody. Throws
  /// as start() does, and has changed nothing then. `kept`: of each of `wanted`, the place of the listener that goes on
  /// as it is, with its connections.
  void prepare(std::span<const ListenerSettings> wanted, std::span<const std::optional<std::size_t>> kept);
  /// The second half: those of prepare() take the place of the others, whose connections are closed. A listener with
  /// other settings on the same address keeps its socket.
  void commit(const DescriptorPlan& descriptors);
  /// In place of commit(): all is as before.
  void give_up() { prepared_.clear(); }
  /// Whether this client has a connection of the listener at this place of the settings.
  [[nodiscard]] bool serves(std::size_t place, ClientId client) const;

  /// Closes listeners and connections. Not from inside a CommandPort call or a result's callback.
  void stop();

  /// In the order of the settings; the ports really in force where 0 was asked for.
  [[nodiscard]] std::vector<std::uint16_t> ports() const;
  [[nodiscard]] const ServerCounters& counters() const;

 private:
  void begin(Listener& listener);
  void report_down();

  std::unique_ptr<ServerContext> context_;
  std::vector<std::shared_ptr<Listener>> listeners_;
  std::vector<std::shared_ptr<Listener>> prepared_;  ///< the listeners after a reload that is under way
};

}  // namespace axisgate::modbus_tcp
