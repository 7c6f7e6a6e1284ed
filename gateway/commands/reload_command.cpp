// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/reload_command.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdio>

#include "gateway/process/control_socket.hpp"

namespace axisgate::app {

int run(const ReloadOptions& options) {
  using boost::asio::local::stream_protocol;
  boost::asio::io_context io;
  stream_protocol::socket socket(io);
  boost::system::error_code error;
  socket.connect(stream_protocol::endpoint('\0' + control_name(options.config)), error);
  if (error) {
    fmt::print(stderr,
               "no gateway runs here with {}: start it with axisgate run, or name the file that it was started with\n",
               options.config);
    return 1;
  }
  boost::asio::write(socket, boost::asio::buffer(kReloadRequest), error);
  std::string answer;
  if (!error) boost::asio::read(socket, boost::asio::dynamic_buffer(answer), error);
  const std::size_t first = answer.find('\n');
  if (first == std::string::npos) {
    fmt::print(stderr, "no answer: the gateway has ended, or it runs as another user (ask as root, or as that user)\n");
    return 1;
  }
  const bool done = answer.substr(0, first) == kReloadDone;
  if (!done) fmt::print(stderr, "refused, and nothing was changed:\n");
  fmt::print(done ? stdout : stderr, "{}", answer.substr(first + 1));
  return done ? 0 : 1;
}

}  // namespace axisgate::app
