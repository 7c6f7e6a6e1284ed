#include "tests/bench/modbus_reads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <vector>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server.hpp"
#include "tests/bench/closed_loop_clients.hpp"
#include "tests/bench/echo_server.hpp"
#include "tests/bench/server_process.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::bench {
namespace {

using Listening = std::function<void(std::uint16_t)>;

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

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Case {
  const char* what;
  std::uint16_t address;
  std::uint16_t registers;
  int clients;
};

void compare(const Case& shape, const ReadsOptions& options) {
  std::array<Byte, 12> request{0, 1, 0, 0, 0, 6, 0xFF, 3};
  store_be16(request, 8, shape.address);
  store_be16(request, 10, shape.registers);
  const std::size_t reply_size = 9U + 2U * shape.registers;
  const ServerProcess ours(serve_axisgate);
  const ServerProcess bare([&](const Listening& listening) { serve_echo(request.size(), reply_size, listening); });

  std::vector<double> our_rates;
  std::vector<double> bare_rates;
  std::vector<double> ratios;
  for (int round = 0; round < options.rounds; ++round) {
    Load load{0, request, reply_size, shape.clients, std::chrono::milliseconds(options.round_ms)};
    const auto rate_of = [&](const ServerProcess& server) {
      load.port = server.port();
      return replies_per_second(load);
    };
    // In turns, and each first every other time: what else the machine does meets both alike.
    double our_rate = round % 2 == 0 ? rate_of(ours) : 0;
    const double bare_rate = rate_of(bare);
    if (round % 2 != 0) our_rate = rate_of(ours);
    our_rates.push_back(our_rate);
    bare_rates.push_back(bare_rate);
    ratios.push_back(our_rate / bare_rate);
  }
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  fmt::print("{:<34} {:>7} {:>11.0f} {:>11.0f} {:>7.1f} % {:>6.1f}..{:.1f} %\n", shape.what, shape.clients,
             median(our_rates), median(bare_rates), 100 * median(ratios), 100 * *least, 100 * *most);
  std::fflush(stdout);
}

}  // namespace

void modbus_reads(const ReadsOptions& options) {
  stay_on_processor(1);  // the servers are on processor 0, one at a time under load
  fmt::print("FC 3 reads per second, axisgate against a bare Asio echo server with the same sizes (goal: 90 %)\n");
  fmt::print("{:<34} {:>7} {:>11} {:>11} {:>9} {:>14}\n", "request", "clients", "axisgate", "bare echo", "ratio",
             "of the rounds");
  for (const int clients : {1, 100}) {
    compare({"one axis, 39 registers", 100, 39, clients}, options);
    compare({"overview of 12 axes, 120 registers", 60010, 120, clients}, options);
  }
}

}  // namespace axisgate::bench
