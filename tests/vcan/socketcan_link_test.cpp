// SPDX-License-Identifier: Apache-2.0
#include "tests/vcan/vcan_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SocketCanLinkTest : public VcanStage {};

TEST_F(SocketCanLinkTest, frames_pass_both_ways_as_they_are) {
  start_all();
  std::vector<can::CanFrame> frames{frame_of(0x123, 0xAA), can::data_frame(0x7FF, {}), can::remote_frame(0x703, 1),
                                    can::data_frame(0x583, std::vector<Byte>{1, 2, 3, 4, 5, 6, 7, 8})};
  frames.push_back(frame_of(0, 7));
  frames.back().extended = true;
  frames.back().id = can::kMaxExtendedId;
  for (const can::CanFrame& frame : frames) peer->send(frame);
  ASSERT_TRUE(await([&] { return diary.frames.size() == frames.size(); }));
  EXPECT_EQ(diary.frames, frames);

  for (const can::CanFrame& frame : frames) link->send(frame, false);
  ASSERT_TRUE(await_heard(frames.size()));
  EXPECT_EQ(heard[0].can_id, 0x123);
  EXPECT_EQ(heard[0].data[0], 0xAA);
  EXPECT_EQ(heard[2].can_id, 0x703U | CAN_RTR_FLAG);
  EXPECT_EQ(heard[2].can_dlc, 1);
  EXPECT_EQ(heard[3].can_dlc, 8);
  EXPECT_EQ(heard[4].can_id, can::kMaxExtendedId | CAN_EFF_FLAG);
}

TEST_F(SocketCanLinkTest, what_it_sends_it_does_not_hear) {
  start_all();
  link->send(frame_of(0x123), false);
  settle();
  EXPECT_TRUE(diary.frames.empty());
}

TEST_F(SocketCanLinkTest, only_what_a_filter_passes_is_handed_over) {
  start_all({{.id = kMark}, {.id = 0x580, .mask = 0x780}});
  for (std::uint32_t id = 0; id <= can::kMaxStandardId; id += 0x40) peer->send(frame_of(id));
  settle();
  ASSERT_EQ(diary.frames.size(), 2);
  EXPECT_EQ(diary.frames[0].id, 0x580);
  EXPECT_EQ(diary.frames[1].id, 0x5C0);
}

TEST_F(SocketCanLinkTest, more_filters_than_the_kernel_takes_work) {
  std::vector<can::CanFilter> filters{{.id = kMark}};
  for (std::uint32_t id = 1; id < 0x7E0; id += 2) filters.push_back({.id = id});
  ASSERT_GT(filters.size(), can::kMaxKernelFilters);
  start_all(filters);
  for (std::uint32_t id = 0x100; id < 0x110; ++id) peer->send(frame_of(id));
  settle();
  ASSERT_EQ(diary.frames.size(), 8);
  for (const can::CanFrame& frame : diary.frames) EXPECT_EQ(frame.id % 2, 1);
}

TEST_F(SocketCanLinkTest, the_instant_of_a_frame_is_when_it_came_in_not_when_it_was_read) {
  start_all();
  const Instant before = runtime.now();
  constexpr std::size_t kFrames = 500;
  for (std::size_t i = 0; i < kFrames; ++i) peer->send(frame_of(1));
  const Instant read_from = runtime.now();
  ASSERT_TRUE(await([&] { return diary.frames.size() == kFrames; }));
  // Two clocks are read one after the other, with anything in between on a busy machine: hence not all of them.
  const auto earlier =
      std::count_if(diary.instants.begin(), diary.instants.end(), [&](Instant instant) { return instant < read_from; });
  EXPECT_GT(earlier, kFrames / 2);
  EXPECT_GE(diary.instants.front(), before - 1ms) << "wall clock and steady clock differ in rate";
  EXPECT_LE(diary.instants.back(), runtime.now());
}

TEST_F(SocketCanLinkTest, an_interface_that_is_missing_at_the_start_is_logged_once_and_picked_up) {
  start();
  ASSERT_TRUE(await([&] { return !log_lines.empty(); }));
  EXPECT_THAT(log_lines, ElementsAre(HasSubstr(interface + " does not exist")));
  add_interface();
  ASSERT_TRUE(await([&] { return log_lines.size() == 2; }));
  EXPECT_THAT(log_lines[1],
              HasSubstr(interface + " is down: ip link set " + interface + " up type can bitrate 500000"));
  EXPECT_TRUE(diary.told.empty()) << "what was never up is not told as down";
  take_up();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_EQ(log_lines.size(), 3);
  EXPECT_EQ(link->trouble().reconnects, 0);
}

TEST_F(SocketCanLinkTest, an_interface_of_another_kind_is_refused_with_words) {
  interface = "lo";
  start();
  ASSERT_TRUE(await([&] { return !log_lines.empty(); }));
  EXPECT_THAT(log_lines[0], HasSubstr("lo is no CAN interface"));
}

TEST_F(SocketCanLinkTest, taken_down_it_is_told_once_with_what_to_do_and_picked_up_when_up) {
  start_all();
  take_down();
  ASSERT_TRUE(await([&] { return diary.down(); }));
  const Instant down = runtime.now();
  ASSERT_TRUE(await([&] { return runtime.now() > down + 1500ms; })) << "tried again meanwhile";
  EXPECT_THAT(diary.told, ElementsAre("up", "down: " + interface + " is down: ip link set " + interface +
                                                " up type can bitrate 500000"));
  take_up();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_EQ(link->trouble().reconnects, 1);
  peer = std::make_unique<CanPeer>(interface);
  peer->send(frame_of(0x123));
  ASSERT_TRUE(await([&] { return !diary.frames.empty(); }));
}

TEST_F(SocketCanLinkTest, removed_and_made_anew_under_the_same_name_it_is_picked_up) {
  start_all();
  remove_interface();
  ASSERT_TRUE(await([&] { return diary.down(); }));
  add_interface();
  take_up();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_EQ(diary.told.size(), 3) << "told once each";
  peer = std::make_unique<CanPeer>(interface);
  peer->send(frame_of(0x123));
  ASSERT_TRUE(await([&] { return !diary.frames.empty(); }));
}

TEST_F(SocketCanLinkTest, removed_and_made_anew_before_anybody_looks_it_is_picked_up) {
  start_all();
  remove_interface();
  add_interface();
  take_up();
  ASSERT_TRUE(await([&] { return diary.told.size() == 3; }));
  EXPECT_TRUE(diary.up());
  peer = std::make_unique<CanPeer>(interface);
  peer->send(frame_of(0x123));
  ASSERT_TRUE(await([&] { return !diary.frames.empty(); }));
}

TEST_F(SocketCanLinkTest, sending_into_an_interface_that_is_down_calls_nobody_back_and_tells_it_later) {
  start_all();
  take_down();
  link->send(frame_of(1), false);
  EXPECT_TRUE(diary.up());
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("is down: ip link set"));
}

TEST_F(SocketCanLinkTest, destroyed_with_frames_waiting_it_calls_nobody) {
  start_all();
  for (int i = 0; i < 10; ++i) peer->send(frame_of(1));
  link.reset();
  context.restart();
  context.poll();
  EXPECT_TRUE(diary.frames.empty());
}

TEST_F(SocketCanLinkTest, whom_it_tells_may_destroy_it) {
  start_all();
  diary.on_received = [this] { link.reset(); };
  for (int i = 0; i < 3; ++i) peer->send(frame_of(1));
  ASSERT_TRUE(await([&] { return link == nullptr; }));
  context.restart();
  context.poll();
  EXPECT_EQ(diary.frames.size(), 1);
}

}  // namespace
}  // namespace axisgate::test
