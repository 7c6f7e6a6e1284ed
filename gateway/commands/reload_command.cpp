// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdio>
#include <string_view>

#include "gateway/process/control_socket.hpp"

namespace axisgate::commands {
namespace {

using boost::asio::local::stream_protocol;
using boost::system::error_code;

/// One request to the gateway that runs with a file, and what it says until it closes the connection.
class Asked {
 public:
  Asked(const std::string& config, std::string_view request) : socket_(io_) {
    socket_.async_connect(
        stream_protocol::endpoint('\0' + process::control_name(config)), [this, request](error_code error) {
          if (error) return refused_.assign(error.message()), void();
          boost::asio::async_write(socket_, boost::asio::buffer(request), [this](error_code failed, std::size_t) {
            if (failed) return;
            boost::asio::async_read(socket_, boost::asio::dynamic_buffer(answer_), [](error_code, std::size_t) {});
          });
        });
  }
  /// It has come to its end in this time.
  [[nodiscard]] bool ends_within(Duration patience) {
    io_.restart();
    io_.run_for(patience);
    return io_.stopped();
  }
  [[nodiscard]] bool connected() const { return refused_.empty(); }
  [[nodiscard]] const std::string& answer() const { return answer_; }

 private:
  boost::asio::io_context io_;
  stream_protocol::socket socket_;
  std::string refused_;
  std::string answer_;
};

}  // namespace

int run(const ReloadOptions& options) {
  const auto alive = [&] { return Asked(options.config, process::kAliveRequest).ends_within(options.patience); };
  const auto hangs = [&](std::string_view outcome) {
    fmt::print(stderr, "the gateway that runs with {} has not answered within {:g} s: it hangs, or was stopped; {}\n",
               options.config, static_cast<double>(options.patience.count()) / 1e9, outcome);
    return 1;
  };
  if (!alive()) return hangs("nothing was asked of it");
  Asked asked(options.config, process::kReloadRequest);
  while (!asked.ends_within(options.patience))
    if (!alive()) return hangs("whether anything was changed, its log will tell");
  if (!asked.connected()) {
    fmt::print(stderr,
               "no gateway runs here with {}: start it with axisgate run, or name the file that it was started with\n",
               options.config);
    return 1;
  }
  const std::string& answer = asked.answer();
  const std::size_t first = answer.find('\n');
  if (first == std::string::npos) {
    fmt::print(stderr, "no answer: the gateway has ended, or it runs as another user (ask as root, or as that user)\n");
    return 1;
  }
  const bool done = answer.substr(0, first) == process::kReloadDone;
  if (!done) fmt::print(stderr, "refused, and nothing was changed:\n");
  fmt::print(done ? stdout : stderr, "{}", answer.substr(first + 1));
  return done ? 0 : 1;
}

}  // namespace axisgate::commands
