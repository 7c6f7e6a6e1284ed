// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/servers.hpp"

#include <boost/asio/io_context.hpp>
#include <span>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/bench/echo_server.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::bench {

void serve_axisgate(const ServerProcess::Ready& listening) {
  boost::asio::io_context io(1);
  AsioRuntime runtime(io);
  ProcessImage image;
  test::fill_image(image, 12, runtime.now());
  test::RememberingPort port;
  modbus_tcp::ClientRegistry clients;
  const Log log;
  modbus_tcp::ListenerSettings settings;
  settings.port = 0;
  settings.max_clients_per_address = 0;
  modbus_tcp::Server server(io, runtime, std::span(&settings, 1), image, port, clients, log);
  server.start(modbus_tcp::take_descriptors({.clients = settings.max_clients}));
  listening(server.ports()[0]);
  io.run();
}

void serve_echo(std::size_t request_size, std::size_t reply_size, const ServerProcess::Ready& listening) {
  boost::asio::io_context io(1);
  const EchoServer server(io, request_size, reply_size);
  listening(server.port());
  io.run();
}

}  // namespace axisgate::bench
