// SPDX-License-Identifier: Apache-2.0
// Up, bytes, loss and return, on a pty; the clock moves by hand, so "at once" and "after a second" can be told apart.
#include "tests/unit/serial/serial_link_stage.hpp"

#include <signal.h>
#include <sys/time.h>

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using SerialLinkTest = SerialLinkStage;

TEST_F(SerialLinkTest, opens_and_says_so_and_carries_bytes_both_ways) {
  Pty pty;
  start_at(pty.device());
  EXPECT_THAT(diary.told, ElementsAre("up"));
  EXPECT_THAT(log_lines, ElementsAre("info: " + pty.device() + " open, 38400 baud 8N1"));
  link->send(bytes_of("request"));
  EXPECT_EQ(pty.read(), "request") << "in the kernel before send() returns";
  pty.write(std::string_view("\x01\x00\x0D\x11\x13\xFF", 6));
  EXPECT_TRUE(await([this] { return diary.received.size() == 6; }));
  EXPECT_EQ(diary.received, std::string_view("\x01\x00\x0D\x11\x13\xFF", 6)) << "no byte means anything to the line";
}

TEST_F(SerialLinkTest, a_send_larger_than_the_kernel_takes_is_finished_in_order) {
  Pty pty;
  start_at(pty.device());
  std::string sent;
  std::string got;
  for (int i = 0; sent.size() < 200'000; ++i) {
    const std::string part = fmt::format("{:04}", i % 10'000);
    link->send(bytes_of(part));
    sent += part;
    if (i % 200 == 199) {
      ASSERT_TRUE(await([&] {
        got += pty.read();
        return got.size() == sent.size();
      }));
    }
  }
  EXPECT_TRUE(await([&] {
    got += pty.read();
    return got.size() == sent.size();
  }));
  EXPECT_EQ(got, sent);
  EXPECT_THAT(diary.told, ElementsAre("up"));
}

/// Signals all the time, as one that reloads may come at any.
class Signals {
 public:
  Signals() {
    struct sigaction counted {};
    counted.sa_handler = [](int) {};
    ::sigaction(SIGALRM, &counted, &before_);
    const itimerval often{{0, 20}, {0, 20}};
    ::setitimer(ITIMER_REAL, &often, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  ~Signals() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::sigaction(SIGALRM, &before_, nullptr);
  }

 private:
  struct sigaction before_ {};
};

TEST_F(SerialLinkTest, a_signal_in_the_middle_of_a_send_loses_neither_the_line_nor_a_byte) {
  Pty pty;
  start_at(pty.device());
  std::string sent, got;
  const Signals signals;
  for (int i = 0; i < 5'000 && diary.told.size() == 1; ++i) {
    const std::string part = fmt::format("{:05}", i);
    link->send(bytes_of(part));
    sent += part;
    got += pty.read();
    if (i % 100 == 0) turn();
  }
  ASSERT_THAT(diary.told, ElementsAre("up"));
  EXPECT_TRUE(await([&] {
    got += pty.read();
    return got.size() == sent.size();
  }));
  EXPECT_EQ(got, sent);
}

TEST_F(SerialLinkTest, a_port_that_takes_nothing_is_opened_anew) {
  Pty pty;
  start_at(pty.device());
  const std::string block(1024, 'x');
  for (int i = 0; i < 1000 && diary.told.size() == 1; ++i) {
    link->send(bytes_of(block));
    turn();
  }
  ASSERT_THAT(diary.told, SizeIs(2));
  EXPECT_EQ(diary.told[1], "down: " + pty.device() + ": it takes no bytes");
}

TEST_F(SerialLinkTest, tells_a_hang_up_once_with_its_reason_also_with_bytes_unsent) {
  for (const bool unsent : {false, true}) {
    Pty pty;
    diary.told.clear();
    start_at(pty.device());
    for (int i = 0; unsent && i < 2; ++i) link->send(bytes_of(std::string(serial::SerialLink::kMaxUnsent, 'x')));
    pty.hang_up();
    link->send(bytes_of("x"));
    EXPECT_TRUE(await([this] { return diary.told.size() > 1; }));
    pass(5s);
    EXPECT_THAT(diary.told, ElementsAre("up", StartsWith("down: " + pty.device() + ": ")));
    link->send(bytes_of("nobody hears this"));
  }
}

TEST_F(SerialLinkTest, comes_back_at_once_when_its_path_appears_though_it_leads_elsewhere) {
  auto first = std::make_unique<Pty>();
  Pty second;
  point(folder / "device", first->device());
  start_at(folder / "device");
  std::filesystem::remove(folder / "device");
  first.reset();
  ASSERT_TRUE(await([this] { return diary.told.size() == 2; }));
  pass(10s);
  EXPECT_THAT(diary.told, SizeIs(2));
  pass(500ms);
  const Instant next_second = runtime.next_deadline();
  point(folder / "device", second.device());
  ASSERT_TRUE(await([this] { return diary.told.size() == 3; }));
  EXPECT_LT(runtime.now(), next_second) << "at once, not with the next try of each second";
  EXPECT_EQ(diary.told[2], "up");
  link->send(bytes_of("hello"));
  EXPECT_EQ(second.read(), "hello");
}

TEST_F(SerialLinkTest, a_device_missing_at_the_start_is_logged_once_and_picked_up_later) {
  start_at(folder / "device");
  for (int i = 0; i < 5; ++i) pass(1s);
  EXPECT_THAT(diary.told, IsEmpty());
  EXPECT_THAT(log_lines,
              ElementsAre("warning: " + folder / "device" + ": No such file or directory; trying again each second"));
  pass(500ms);
  Pty pty;
  point(folder / "device", pty.device());
  EXPECT_TRUE(await([this] { return diary.told.size() == 1; }));
}

TEST_F(SerialLinkTest, a_port_in_use_is_told_and_taken_when_it_is_free) {
  Pty pty;
  LinkDiary of_other;
  auto other = make_link(pty.device());
  other->start(of_other);
  turn();
  start_at(pty.device());
  EXPECT_THAT(diary.told, IsEmpty());
  EXPECT_EQ(log_lines.back(), "warning: " + pty.device() + ": another process is using it; trying again each second");
  other.reset();
  pass(1s);
  EXPECT_THAT(diary.told, ElementsAre("up"));
}

TEST_F(SerialLinkTest, opens_anew_when_asked_also_from_inside_its_events) {
  Pty pty;
  start_at(pty.device());
  link->reopen("noise");
  turn();
  EXPECT_THAT(diary.told, ElementsAre("up", "down: " + pty.device() + ": noise", "up"));
  diary.on_received = [this] { link->reopen("noise"); };
  pty.write("x");
  EXPECT_TRUE(await([this] { return diary.told.size() == 5; }));
  pty.write("y");
  EXPECT_TRUE(await([this] { return diary.received == "xy"; }));
}

TEST_F(SerialLinkTest, may_be_destroyed_from_inside_its_events) {
  for (auto LinkDiary::*event : {&LinkDiary::on_up, &LinkDiary::on_down, &LinkDiary::on_received}) {
    Pty pty;
    LinkDiary brief;
    brief.*event = [this] { link.reset(); };
    link = make_link(pty.device());
    link->start(brief);
    turn();
    if (link != nullptr) pty.write("x");
    if (event == &LinkDiary::on_down) pty.hang_up();
    EXPECT_TRUE(await([this] { return link == nullptr; }));
    turn();
  }
}

TEST_F(SerialLinkTest, destroyed_with_everything_pending_it_calls_nobody) {
  Pty pty;
  start_at(pty.device());
  for (int i = 0; i < 100; ++i) link->send(bytes_of(std::string(1000, 'x')));
  pty.write("unread");
  link.reset();
  turn();
  pass(10s);
  EXPECT_THAT(diary.told, ElementsAre("up"));
  EXPECT_EQ(diary.received, "");
}

}  // namespace
}  // namespace axisgate::test
