// SPDX-License-Identifier: Apache-2.0
// The watchdog of a service: who stalls is not told to be alive.
#include "gateway/process/service.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::process {
namespace {

using namespace std::chrono_literals;
using test::ManualRuntime;

/// The service manager's end, an abstract socket; and the environment that names it.
class Manager {
 public:
  Manager() {
    const std::string name = "axisgate-test/" + std::to_string(::getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + 1, name.data(), name.size());
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ::setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
    ::setenv("WATCHDOG_USEC", "4000000", 1);
    ::unsetenv("WATCHDOG_PID");
  }
  ~Manager() {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
    ::close(socket_);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// Whether there is a message, perhaps a little later.
  bool has_news() const {
    pollfd wanted{socket_, POLLIN, 0};
    return ::poll(&wanted, 1, 10) == 1;
  }
  /// The next message; waits for it.
  std::string hears() const {
    std::array<char, 512> text{};
    const ssize_t size = ::recv(socket_, text.data(), text.size(), 0);
    return size < 0 ? std::string() : std::string(text.data(), static_cast<std::size_t>(size));
  }

 private:
  int socket_ = -1;
};

TEST(Service, TheWatchdogIsFedWhileEveryBusHasItsTurn) {
  const Manager manager;
  ManualRuntime runtime;
  bool all_turn = true;
  std::vector<Duration> asked;
  Service service(runtime, [&](Duration slack) {
    asked.push_back(slack);
    return all_turn;
  });
  // One that is still on its way when the next is due takes its place.
  for (int i = 0; i < 3; ++i) {
    while (!manager.has_news()) runtime.advance_by(1s);
    EXPECT_EQ(manager.hears(), "WATCHDOG=1");
  }
  EXPECT_LE(asked.back(), 2s) << "half of the watchdog's time is left for the end of it";
  all_turn = false;
  service.reloading();
  while (manager.hears() == "WATCHDOG=1") {
  }
  asked.clear();
  runtime.advance_by(10s);
  EXPECT_GE(asked.size(), 10U);
  service.stopping();
  EXPECT_EQ(manager.hears(), "STOPPING=1\nSTATUS=ending: only stops are accepted") << "nothing came in between";
}

TEST(Service, WithoutAManagerNothingIsAsked) {
  ManualRuntime runtime;
  int asked = 0;
  Service service(runtime, [&](Duration) { return ++asked > 0; });
  service.ready("here");
  service.reloading();
  runtime.advance_by(10s);
  service.stopping();
  EXPECT_EQ(asked, 0);
}

}  // namespace
}  // namespace axisgate::process
