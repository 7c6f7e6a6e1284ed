// SPDX-License-Identifier: Apache-2.0
// Two links joined by socat, with the clock of the product: everything as on a machine, but for the cable.
#include <spawn.h>
#include <sys/wait.h>
#include <csignal>

#include "adapters/asio/asio_runtime.hpp"
#include "tests/unit/serial/serial_link_stage.hpp"

namespace axisgate::test {
namespace {

class Socat {
 public:
  Socat(const std::string& a, const std::string& b) {
    std::string from = "pty,raw,echo=0,link=" + a;
    std::string to = "pty,raw,echo=0,link=" + b;
    std::string name = "socat";
    std::array<char*, 4> arguments{name.data(), from.data(), to.data(), nullptr};
    EXPECT_EQ(::posix_spawnp(&pid_, "socat", nullptr, nullptr, arguments.data(), environ), 0);
  }
  Socat(const Socat&) = delete;
  Socat& operator=(const Socat&) = delete;
  ~Socat() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }

 private:
  pid_t pid_ = 0;
};

TEST(SerialLinkSocat, two_links_find_each_other_exchange_bytes_and_survive_the_loss_of_the_cable) {
  Folder folder;
  boost::asio::io_context context;
  AsioRuntime runtime(context);
  const Log log;
  LinkDiary left_diary;
  LinkDiary right_diary;
  serial::SerialLink left("left", {.device = folder / "left"}, context, runtime, log);
  serial::SerialLink right("right", {.device = folder / "right"}, context, runtime, log);
  left.start(left_diary);
  right.start(right_diary);
  std::size_t ups = 0;
  for (int cable = 0; cable < 2; ++cable) {
    const auto told = [&](std::size_t count) {
      return left_diary.told.size() == count && right_diary.told.size() == count;
    };
    {
      const Socat socat(folder / "left", folder / "right");
      ASSERT_TRUE(run_until(context, [&] { return told(2 * ups + 1); })) << "cable " << cable;
      ++ups;
      left_diary.received.clear();
      right_diary.received.clear();
      left.send(bytes_of("ping"));
      ASSERT_TRUE(run_until(context, [&] { return right_diary.received == "ping"; }));
      right.send(bytes_of("pong"));
      ASSERT_TRUE(run_until(context, [&] { return left_diary.received == "pong"; }));
    }
    ASSERT_TRUE(run_until(context, [&] { return told(2 * ups); })) << "both hear that the cable is gone";
  }
}

}  // namespace
}  // namespace axisgate::test
