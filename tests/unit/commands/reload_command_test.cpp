// SPDX-License-Identifier: Apache-2.0
// `axisgate reload` against a gateway's end of the control socket: one that hangs, and one that lives.
#include "gateway/commands/commands.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <thread>

#include "gateway/process/control_socket.hpp"

namespace axisgate::commands {
namespace {

using namespace std::chrono_literals;
using boost::asio::local::stream_protocol;
using testing::ElementsAre;

/// Where a gateway hears of it: connections wait there until they are answered.
struct Heard {
  std::string path = "/no-such-folder/" + std::to_string(::getpid()) + ".json";
  boost::asio::io_context io;
  stream_protocol::acceptor acceptor{io, stream_protocol::endpoint('\0' + process::control_name(path))};

  std::string answer(const std::string& with) {
    stream_protocol::socket asker = acceptor.accept();
    std::string request(process::kReloadRequest.size(), '\0');
    boost::asio::read(asker, boost::asio::buffer(request));
    boost::asio::write(asker, boost::asio::buffer(with));
    return request;
  }
};

TEST(ReloadCommand, GivesUpOnAGatewayThatHangs) {
  Heard heard;
  testing::internal::CaptureStderr();
  EXPECT_EQ(run(ReloadOptions{.config = heard.path, .patience = 2ms}), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "the gateway that runs with " + heard.path +
                " has not answered within 0.002 s: it hangs, or was stopped; nothing was asked of it\n");
}

TEST(ReloadCommand, AsksAGatewayThatLivesAndWaitsForTheOutcome) {
  Heard heard;
  int code = -1;
  testing::internal::CaptureStdout();
  std::thread command([&] { code = run(ReloadOptions{.config = heard.path, .patience = 1h}); });
  const std::string first = heard.answer("");
  const std::string second = heard.answer("done\nbus lift: changed\n");
  command.join();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "bus lift: changed\n");
  EXPECT_EQ(code, 0);
  EXPECT_THAT((std::vector{first, second}), ElementsAre(process::kAliveRequest, process::kReloadRequest));
}

}  // namespace
}  // namespace axisgate::commands
