// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <span>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/echo_server.hpp"
#include "tests/bench/process.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::bench {
namespace {

using Listening = ServerProcess::Ready;

void serve_axisgate(const Listening& listening) {
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

void serve_echo(std::size_t request_size, std::size_t reply_size, const Listening& listening) {
  boost::asio::io_context io(1);
  const EchoServer server(io, request_size, reply_size);
  listening(server.port());
  io.run();
}

void compare(const char* what, const ReadRequest& request, int clients, const BenchOptions& options) {
  const ServerProcess ours(serve_axisgate);
  const ServerProcess echo(
      [&](const Listening& listening) { serve_echo(request.bytes.size(), request.reply_size, listening); });
  const std::chrono::milliseconds lasting(options.quick ? 100 : 200);
  Samples rates, echo_rates;
  for (int round = 0; round < (options.quick ? 3 : 25); ++round) {
    const auto measure = [&](const ServerProcess& server, Samples& to) {
      to.push_back(replies_per_second(server.port(), request, clients, lasting));
    };
    // In turns, and each first every other time: what else the machine does meets both alike.
    if (round % 2 == 0) measure(ours, rates);
    measure(echo, echo_rates);
    if (round % 2 != 0) measure(ours, rates);
  }
  options.report.row(fmt::format("{}, {} clients, reads/s", what, clients), median(rates), bare(median(echo_rates)));
}

}  // namespace

void modbus_reads(const BenchOptions& options) {
  stay_on_processor(1);  // the servers are on processor 0, one at a time under load
  for (const int clients : {1, 100}) {
    compare("one axis, 39 registers", {100, 39}, clients, options);
    compare("overview of 12 axes, 120 registers", {60010, 120}, clients, options);
  }
}

}  // namespace axisgate::bench
