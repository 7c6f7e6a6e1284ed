#include "adapters/can/can_send_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;
constexpr Instant kStart = Instant{} + 1h;

CanFrame frame(std::uint32_t id) { return data_frame(id, {}); }

std::vector<std::uint32_t> drain(SendQueue& queue) {
  std::vector<std::uint32_t> ids;
  for (; !queue.empty(); queue.pop()) ids.push_back(queue.front().id);
  return ids;
}

TEST(SendQueue, keeps_the_order) {
  SendQueue queue;
  for (std::uint32_t id = 1; id <= 4; ++id) ASSERT_TRUE(queue.push(frame(id), false, kStart));
  EXPECT_EQ(drain(queue), (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

TEST(SendQueue, urgent_frames_go_before_the_others_and_in_their_own_order) {
  SendQueue queue;
  ASSERT_TRUE(queue.push(frame(1), false, kStart));
  ASSERT_TRUE(queue.push(frame(2), true, kStart));
  ASSERT_TRUE(queue.push(frame(3), false, kStart));
  ASSERT_TRUE(queue.push(frame(4), true, kStart));
  EXPECT_EQ(drain(queue), (std::vector<std::uint32_t>{2, 4, 1, 3}));
}

TEST(SendQueue, takes_no_more_than_its_bound) {
  SendQueue queue;
  for (std::size_t i = 0; i < kMaxUnsentFrames; ++i) ASSERT_TRUE(queue.push(frame(1), false, kStart));
  EXPECT_FALSE(queue.push(frame(2), false, kStart));
  EXPECT_FALSE(queue.push(frame(2), true, kStart));
  EXPECT_EQ(queue.size(), kMaxUnsentFrames);
}

TEST(SendQueue, the_frame_that_waits_longest_is_overdue_first_also_behind_urgent_ones) {
  SendQueue queue;
  EXPECT_EQ(queue.overdue_at(), kNever);
  ASSERT_TRUE(queue.push(frame(1), false, kStart));
  ASSERT_TRUE(queue.push(frame(2), true, kStart + 100ms));
  EXPECT_EQ(queue.overdue_at(), kStart + kMaxSendWait);
  queue.pop();
  EXPECT_EQ(queue.overdue_at(), kStart + kMaxSendWait) << "the urgent one went";
  queue.pop();
  EXPECT_EQ(queue.overdue_at(), kNever);
}

}  // namespace
}  // namespace axisgate::can
