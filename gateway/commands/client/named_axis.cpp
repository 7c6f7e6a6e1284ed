// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/named_axis.hpp"

#include <fmt/format.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>

#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

namespace axisgate::commands {
namespace {

using boost::asio::awaitable;

constexpr std::chrono::milliseconds kAnswerLimit{2000};
constexpr std::chrono::milliseconds kConnectLimit{3000};

std::string text(const HostPort& place) { return modbus_tcp::address_text(place.host, place.port); }

awaitable<NamesRead> ask(TopClient& client, const HostPort& place) {
  const std::string problem = co_await client.connect(place.host, place.port, kConnectLimit);
  if (!problem.empty()) co_return NamesRead{{}, problem};
  co_return co_await read_names(client, kAnswerLimit);
}

NamesRead names_at(const HostPort& place) {
  boost::asio::io_context io(1);
  TopClient client(io);
  NamesRead read;
  boost::asio::co_spawn(io, ask(client, place), [&](const std::exception_ptr& failed, NamesRead told) {
    if (failed) std::rethrow_exception(failed);
    read = std::move(told);
  });
  io.run();
  return read;
}

}  // namespace

std::optional<OwnPlace> own_place(const std::string& command, const std::string& config, const std::string& usual) {
  const std::string& file = config.empty() ? usual : config;
  errno = 0;
  std::ifstream in(file);
  const int error = in ? 0 : errno;
  if (config.empty() && error == ENOENT) return OwnPlace{kUsualPlace};
  const std::string text_of_file(std::istreambuf_iterator<char>(in), {});
  auto own = own_gateway_in(text_of_file);
  if (own) return OwnPlace{own->place, ConfiguredNames{file, std::move(own->names)}};
  fmt::print(stderr, "axisgate {}: {} does not say where the gateway listens{}: write HOST:PORT{}\n", command, file,
             error == 0 ? "" : fmt::format(" ({})", std::generic_category().message(error)),
             config.empty() ? ", or --config CONFIG" : "");
  return std::nullopt;
}

awaitable<NamesRead> read_names(TopClient& client, TopClient::Limit limit) {
  NamesRead read;
  for (int object = modbus_tcp::kNamesObject; object <= modbus_tcp::kLastNamesObject; ++object) {
    const ObjectRead reported = co_await client.identification(static_cast<std::uint8_t>(object), limit);
    if (!reported.problem.empty()) co_return NamesRead{{}, reported.problem};
    if (reported.text.empty()) break;
    add_names(read.names, reported.text);
  }
  co_return read;
}

std::optional<FoundAxis> find_typed_axis(const std::string& command, const TypedAxis& typed, const std::string& usual) {
  OwnPlace own;
  if (typed.endpoint.empty()) {
    auto found = own_place(command, typed.config, usual);
    if (!found) return std::nullopt;
    own = std::move(*found);
  } else if (const auto place = parse_host_port(typed.endpoint)) {
    own.place = *place;
    if (const auto number = axis_number_in(typed.axis)) return FoundAxis{*place, *number};
  } else {
    fmt::print(stderr, "axisgate {}: {}\n", command, host_port_mistake(typed.endpoint));
    return std::nullopt;
  }
  const NamesRead read = names_at(own.place);
  if (!read.problem.empty()) {
    fmt::print(stderr, "axisgate {}: the gateway at {}{} cannot be asked: {}; write HOST:PORT if it is elsewhere\n",
               command, text(own.place), own.configured ? " (" + own.configured->file + ")" : "", read.problem);
    return std::nullopt;
  }
  const auto meant = axis_meant(typed.axis, read.names, own.configured ? &*own.configured : nullptr);
  if (const auto* why = std::get_if<std::string>(&meant)) {
    fmt::print(stderr, "axisgate {}: {}: {}\n", command, text(own.place), *why);
    return std::nullopt;
  }
  const AxisNumber number = std::get<AxisNumber>(meant);
  return FoundAxis{own.place, number,
                   fmt::format("axis {} \"{}\" at {}", number, read.names.at(number), text(own.place))};
}

}  // namespace axisgate::commands
