// SPDX-License-Identifier: Apache-2.0
// Up, loss in each state and return, on a pty; the clock moves by hand, so "at once" and "after a second" can be told
// apart.
#include "tests/unit/modbus_rtu/libmodbus_link_stage.hpp"

namespace axisgate::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using LibmodbusLinkTest = LibmodbusLinkStage;

TEST_F(LibmodbusLinkTest, opens_a_pty_with_parity_each_time_though_no_pty_has_it) {
  Pty pty;
  for (int i = 0; i < 3; ++i) {
    RtuLinkDiary one;
    link = std::make_unique<modbus_rtu::LibmodbusLink>(
        "lift", serial::SerialSettings{.device = pty.device(), .baud = 19200, .parity = serial::Parity::even}, context,
        runtime, log);
    link->start(one);
    EXPECT_TRUE(await([&] { return one.up(); }));
    link.reset();
  }
}

// --- Loss in each state: told at once, by itself, once; the port is back when the device is. ------------------------

class LibmodbusLinkLoss : public LibmodbusLinkStage {
 protected:
  void SetUp() override {
    point(folder / "device", pty->device());
    open_at(folder / "device");
  }
  void pull() {
    std::filesystem::remove(folder / "device");
    pty.reset();
  }
  /// The clock stands: no deadline of ours has to pass for the loss to be told.
  void expect_down_and_back() {
    ASSERT_TRUE(await([this] { return diary.down(); }));
    EXPECT_THAT(diary.told.back(), StartsWith("down: " + folder / "device" + ": "));
    pass(10s);
    ASSERT_TRUE(await([this] { return runtime.next_deadline() != kNever; })) << "the try of the last second has ended";
    pass(500ms);
    EXPECT_THAT(diary.told, SizeIs(2));
    const Instant next_second = runtime.next_deadline();
    Pty again;
    point(folder / "device", again.device());
    ASSERT_TRUE(await([this] { return diary.up(); }));
    EXPECT_LT(runtime.now(), next_second) << "at once, not with the next try of each second";
    diary.frames.clear();
    ask(again, 100);
    answer(again, "01 03 02 C0 37");
    ASSERT_TRUE(await([this] { return !diary.frames.empty(); }));
    EXPECT_THAT(diary.frames, ElementsAre("100: 01 03 02 C0 37")) << "nothing of before the loss";
  }
  std::unique_ptr<Pty> pty = std::make_unique<Pty>();
};

TEST_F(LibmodbusLinkLoss, while_an_answer_is_awaited_or_in_its_middle) {
  // The worker's patience is 20 s here: only the hang-up itself can end its wait.
  ask(*pty);
  answer(*pty, from_hex("01 03 02"));
  turn();
  pull();
  expect_down_and_back();
  EXPECT_EQ(diary.noise, 0u) << "the half frame went with the line";
}

TEST_F(LibmodbusLinkLoss, with_a_frame_just_sent) {
  pull();
  send(1, "01 03 32 00 00 01");
  expect_down_and_back();
}

TEST_F(LibmodbusLinkLoss, of_a_port_that_takes_nothing_any_more) {
  // Nobody reads at the far end until the kernel has no room for another frame.
  modbus_rtu::ExchangeNumber number = 0;
  const ByteRow longest(modbus_rtu::kMaxFrame, 0x11);
  ASSERT_TRUE(await([&] {
    if (diary.up()) link->transmit(++number, longest);
    return diary.down();
  }));
  EXPECT_EQ(diary.told.back(), "down: " + folder / "device" + ": it takes no bytes");
  EXPECT_LT(number, 10'000u);
  pass(1s);
  EXPECT_TRUE(await([this] { return diary.up(); })) << "opened anew";
}

// --- Coming back ---------------------------------------------------------------------------------------------------

TEST_F(LibmodbusLinkTest, a_device_missing_at_the_start_is_logged_once_and_picked_up_later) {
  start_at(folder / "device");
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(await([this] { return runtime.next_deadline() > runtime.now(); }));
    pass(1s);
  }
  ASSERT_TRUE(await([this] { return !log_lines.empty(); }));
  EXPECT_THAT(diary.told, IsEmpty());
  EXPECT_THAT(log_lines,
              ElementsAre("warning: " + folder / "device" + ": No such file or directory; trying again each second"));
  Pty pty;
  point(folder / "device", pty.device());
  EXPECT_TRUE(await([this] {
    pass(20ms);
    return diary.up();
  }));
}

TEST_F(LibmodbusLinkTest, a_port_in_use_is_told_and_taken_when_it_is_free) {
  Pty pty;
  RtuLinkDiary of_other;
  auto other = make_link(pty.device());
  other->start(of_other);
  ASSERT_TRUE(await([&] { return of_other.up(); }));
  start_at(pty.device());
  ASSERT_TRUE(await([this] { return log_lines.size() == 2; }));
  EXPECT_THAT(diary.told, IsEmpty());
  EXPECT_EQ(log_lines.back(), "warning: " + pty.device() + ": another process is using it; trying again each second");
  other.reset();
  pass(1s);
  EXPECT_TRUE(await([this] { return diary.up(); }));
}

TEST_F(LibmodbusLinkTest, opens_and_says_so_and_opens_anew_when_asked_but_never_from_inside_the_call) {
  Pty pty;
  open_at(pty.device());
  EXPECT_THAT(log_lines, ElementsAre("info: " + pty.device() + " open, 19200 baud 8N1"));
  link->reopen("noise");
  EXPECT_THAT(diary.told, ElementsAre("up"));
  ASSERT_TRUE(await([this] { return diary.told.size() == 3; }));
  EXPECT_THAT(diary.told, ElementsAre("up", "down: " + pty.device() + ": noise", "up"));
  ask(pty);
}

TEST_F(LibmodbusLinkTest, asked_to_open_anew_while_it_is_being_lost_it_tells_one_end) {
  for (int moment = 0; moment < 30; ++moment) {
    RtuLinkDiary one;
    Pty first;
    Pty second;
    point(folder / "device", first.device());
    link = make_link(folder / "device");
    link->start(one);
    ASSERT_TRUE(await([&] { return one.up(); }));
    point(folder / "device", second.device());
    first.hang_up();
    // The worker may have noticed by now, or not.
    const auto until = std::chrono::steady_clock::now() + moment * 20us;
    while (std::chrono::steady_clock::now() < until) continue;
    link->reopen("noise");
    ASSERT_TRUE(await([&] {
      pass(20ms);
      return one.told.size() >= 3;
    }));
    EXPECT_THAT(one.told, ElementsAre("up", StartsWith("down: "), "up"));
    link.reset();
  }
}

// --- The end -------------------------------------------------------------------------------------------------------

TEST_F(LibmodbusLinkTest, may_be_destroyed_from_inside_its_events) {
  for (auto RtuLinkDiary::*event :
       {&RtuLinkDiary::on_up, &RtuLinkDiary::on_down, &RtuLinkDiary::on_heard, &RtuLinkDiary::on_noise}) {
    Pty pty;
    RtuLinkDiary brief;
    brief.*event = [this] { link.reset(); };
    link = make_link(pty.device());
    link->start(brief);
    EXPECT_TRUE(await([&] { return link == nullptr || brief.up(); }));
    if (event == &RtuLinkDiary::on_down) pty.hang_up();
    if (event == &RtuLinkDiary::on_heard) answer(pty, "01 03 02 C0 37");
    if (event == &RtuLinkDiary::on_noise) answer(pty, from_hex("01 83 02 00 00"));
    EXPECT_TRUE(await([this] { return link == nullptr; }));
    turn();
  }
}

TEST_F(LibmodbusLinkTest, destroyed_with_a_request_or_frames_or_a_reopening_on_their_way_it_calls_nobody) {
  const std::pair<const char*, std::function<void(const Pty&)>> states[] = {
      {"an answer awaited", [this](const Pty& pty) { ask(pty); }},
      {"frames on the way to the core",
       [](const Pty& pty) {
         for (int i = 0; i < 10; ++i) answer(pty, "01 03 02 C0 37");
       }},
      {"asked to open anew", [this](const Pty&) { link->reopen("noise"); }},
  };
  for (const auto& [what, prepare] : states) {
    SCOPED_TRACE(what);
    Pty pty;
    diary.told.clear();
    open_at(pty.device());
    prepare(pty);
    link.reset();
    pass(10s);
    EXPECT_THAT(diary.told, ElementsAre("up"));
    EXPECT_THAT(diary.frames, IsEmpty());
  }
}

TEST_F(LibmodbusLinkTest, destroyed_in_the_middle_of_a_frame_it_ends_within_its_patience) {
  Pty pty;
  open_at(pty.device(), modbus_rtu::kAdapterLatency);
  answer(pty, from_hex("01 03 02"));
  link.reset();  // hangs here for ever if the worker were not to come back
  turn();
  EXPECT_THAT(diary.told, ElementsAre("up"));
}

TEST_F(LibmodbusLinkTest, destroyed_before_its_first_try_has_ended_it_calls_nobody) {
  for (int i = 0; i < 50; ++i) {
    Pty pty;
    start_at(pty.device());
    turn();
    link.reset();
    turn();
  }
  EXPECT_THAT(diary.told, Each("up")) << "where the try was quicker";
}

}  // namespace
}  // namespace axisgate::test
