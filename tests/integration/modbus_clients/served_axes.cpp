// SPDX-License-Identifier: Apache-2.0
// The server that foreign Modbus clients are tried on: our own Server and Session over an image filled by hand.
// Axis 1 does what it is told at once, axis 2 is offline, axis 3's drive refuses everything, axis 4 never answers in
// time. Prints "PORT n" and serves until its standard input ends.
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdio>
#include <cstring>
#include <exception>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace {

using namespace axisgate;

class ServedAxes final : public CommandPort {
 public:
  explicit ServedAxes(ProcessImage& image) : image_(image) {}

  std::optional<BatchResult> submit(AxisNumber number, const WriteBatch& batch, BatchCallback) override {
    AxisImage* axis = image_.find(number);
    if (axis == nullptr) return BatchResult{{Errc::no_path, 0}};
    switch (number) {
      case 2:
        return BatchResult{{Errc::offline, 0}};
      case 3:
        return BatchResult{{Errc::refused_by_drive, 0x06090030}};
      case 4:
        return BatchResult{{Errc::timed_out, 0}};
      default:
        return done(*axis, batch);
    }
  }
  void client_gone(ClientId) override {}
  bool holds(AxisNumber, Quantity, std::int64_t) const override { return false; }
  bool owner_asks(AxisNumber, ClientId, Quantity, std::int64_t) const override { return false; }
  std::int32_t set_position_value(AxisNumber) const override { return 0; }

 private:
  static BatchResult done(AxisImage& axis, const WriteBatch& batch) {
    for (const Setpoint& setpoint : batch.setpoints) axis[setpoint.quantity].value = setpoint.value;
    if (batch.mode) axis[Quantity::mode].value = axis[Quantity::mode_display].value = *batch.mode;
    if (batch.controlword) axis[Quantity::controlword].value = *batch.controlword;
    if (batch.command == Command::disable) {
      axis.inputs &= static_cast<std::uint16_t>(~bit(AxisInput::enabled));
      axis.level_coils &= static_cast<std::uint16_t>(~1U);
    }
    if (batch.command == Command::enable) {
      axis.inputs |= bit(AxisInput::enabled);
      axis.level_coils |= 1U;
    }
    return {};
  }
  ProcessImage& image_;
};

int serve(int argc, char** argv) {
  boost::asio::io_context io(1);
  AsioRuntime runtime(io);
  ProcessImage image;
  test::fill_image(image, 4, runtime.now());
  image.find(2)->link_state = LinkState::offline;
  ServedAxes port(image);
  modbus_tcp::ClientRegistry clients;
  const Log log([](LogLevel, std::string_view source, std::string_view message) {
    std::fprintf(stderr, "%.*s: %.*s\n", static_cast<int>(source.size()), source.data(),
                 static_cast<int>(message.size()), message.data());
  });
  modbus_tcp::ListenerSettings settings;
  settings.port = 0;
  settings.client_is_address = true;  // mbpoll is a new connection each time
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--low-first") == 0) settings.low_word_first = true;
    if (std::strcmp(argv[i], "--per-axis") == 0) settings.per_axis_units = true;
  }
  modbus_tcp::Server server(io, runtime, std::span(&settings, 1), image, port, clients, log);
  server.start(modbus_tcp::take_descriptors({.clients = settings.max_clients}));
  std::printf("PORT %u\n", static_cast<unsigned>(server.ports()[0]));
  std::fflush(stdout);

  boost::asio::posix::stream_descriptor input(io, ::dup(STDIN_FILENO));
  std::array<char, 1> ignored{};
  input.async_read_some(boost::asio::buffer(ignored), [&](const boost::system::error_code&, std::size_t) {
    server.stop();
    io.stop();
  });
  io.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return serve(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
