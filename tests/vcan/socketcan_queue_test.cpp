// SPDX-License-Identifier: Apache-2.0
// Queues that overflow. vcan itself never fills: a token bucket (tc, sch_tbf) that lets nothing through takes the place
// of a bus on which nobody acknowledges.
#include "tests/vcan/vcan_stage.hpp"

namespace axisgate::test {
namespace {

using testing::HasSubstr;

class SocketCanQueueTest : public VcanStage {
 protected:
  /// After the first frame, which the bucket lets pass, `frames` more fit into the driver's queue.
  void jam(int frames) const {
    run(fmt::format("tc qdisc add dev {} root tbf rate 8bit burst 16 limit {}", interface, 16 * frames));
  }
  void free() const { run("tc qdisc del dev " + interface + " root"); }
};

TEST_F(SocketCanQueueTest, what_the_system_dropped_is_counted) {
  start_all();
  // Nobody reads meanwhile. More than any receive buffer of ours holds, even where its size cannot be forced.
  constexpr std::uint32_t kSent = 40'000;
  for (std::uint32_t i = 0; i < kSent; ++i) peer->send(frame_of(1));
  ASSERT_TRUE(await([&] {
    const std::size_t before = diary.frames.size();
    context.restart();
    context.poll();
    return diary.frames.size() == before;
  }));
  settle();  // the count comes with the next frame
  EXPECT_GT(link->trouble().lost_in, 0);
  EXPECT_EQ(diary.frames.size() + link->trouble().lost_in + dropped_before_any_socket(), kSent);
  EXPECT_TRUE(diary.up());
}

TEST_F(SocketCanQueueTest, one_turn_of_the_loop_hands_over_no_more_than_its_bound) {
  start_all();
  for (int i = 0; i < 200; ++i) peer->send(frame_of(1));
  std::size_t most = 0;
  ASSERT_TRUE(await([&] {
    const std::size_t before = diary.frames.size();
    context.restart();
    context.poll_one();
    most = std::max(most, diary.frames.size() - before);
    return diary.frames.size() == 200;
  }));
  EXPECT_LE(most, can::kMaxFramesPerTurn);
}

TEST_F(SocketCanQueueTest, a_full_queue_of_the_driver_is_waited_for) {
  start_all();
  jam(2);
  for (Byte i = 0; i < 10; ++i) link->send(frame_of(0x100, i), false);
  EXPECT_EQ(link->trouble().send_waits, 1);
  EXPECT_TRUE(diary.up());
  free();
  ASSERT_TRUE(await_heard(10));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(heard[i].data[0], i) << "each once, and in order";
  EXPECT_TRUE(diary.up());
}

TEST_F(SocketCanQueueTest, an_urgent_frame_goes_before_what_waits) {
  start_all();
  jam(1);
  for (Byte i = 0; i < 5; ++i) link->send(frame_of(0x100, i), false);
  link->send(frame_of(0x000, 0xEE), true);
  ASSERT_TRUE(await_heard(2)) << "one passed the bucket, one lies in it";
  free();
  ASSERT_TRUE(await_heard(6));
  std::vector<int> order;
  for (const can_frame& frame : heard) order.push_back(frame.data[0]);
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 0xEE, 2, 3, 4));
}

TEST_F(SocketCanQueueTest, few_frames_lie_where_they_cannot_be_called_back) {
  start_all();
  jam(1000);
  constexpr Byte kFrames = 40;
  for (Byte i = 0; i < kFrames; ++i) link->send(frame_of(0x100, i), false);
  EXPECT_EQ(link->trouble().send_waits, 1) << "the socket's own limit stops before the driver's queue is full";
  link->send(frame_of(0x000, 0xEE), true);
  free();
  ASSERT_TRUE(await_heard(kFrames + 1));
  const auto urgent =
      std::find_if(heard.begin(), heard.end(), [](const can_frame& frame) { return frame.can_id == 0; });
  ASSERT_NE(urgent, heard.end());
  EXPECT_LE(urgent - heard.begin(), 12) << "those that went before it were with the driver";
}

TEST_F(SocketCanQueueTest, a_queue_that_stays_full_takes_the_link_down_and_up_again_when_it_moves) {
  start_all();
  jam(1000);
  for (Byte i = 0; i < 20; ++i) link->send(frame_of(0x100, i), false);
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("nobody acknowledges or the bus is overloaded"));
  const Instant down = runtime.now();
  ASSERT_TRUE(await([&] { return runtime.now() > down + 2500ms; }));
  EXPECT_TRUE(diary.down()) << "still jammed";
  (void)peer->read();
  free();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  link->send(frame_of(0x200), false);
  ASSERT_TRUE(await_heard(1));
  EXPECT_EQ(heard[0].can_id, 0x200) << "commands that have become old are not sent";
}

TEST_F(SocketCanQueueTest, more_frames_than_the_bound_take_the_link_down) {
  start_all();
  jam(2);
  for (std::size_t i = 0; i < can::kMaxUnsentFrames + 10; ++i) link->send(frame_of(1), false);
  EXPECT_TRUE(diary.up()) << "send() calls nobody back";
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("64 frames wait"));
}

TEST_F(SocketCanQueueTest, with_the_controllers_complaints_a_full_queue_is_nobody_acknowledging) {
  start_all();
  jam(2);
  auto other = std::make_unique<CanPeer>(interface);
  for (Byte i = 0; i < 10; ++i) link->send(frame_of(0x100, i), false);
  // The jam would keep the error frame out, too: there is room for that one in a new jam, and then no more.
  free();
  jam(1);
  other->send_error(CAN_ERR_CRTL | CAN_ERR_ACK, CAN_ERR_CRTL_TX_PASSIVE);
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("nobody acknowledges: check the cable"));
}

}  // namespace
}  // namespace axisgate::test
