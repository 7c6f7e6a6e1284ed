// SPDX-License-Identifier: Apache-2.0
// The link as the product makes it, on a real pty, before a simulated adapter.
#include <gmock/gmock.h>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/can/link/make_can_link.hpp"
#include "tests/unit/can/can_diary.hpp"
#include "tests/unit/can/lawicel_adapter.hpp"
#include "tests/unit/serial/serial_link_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SlcanLinkPtyTest : public testing::Test {
 protected:
  void plug_in() {
    pty = std::make_unique<Pty>();
    point(folder / "adapter", pty->device());
  }
  void pull_out() {
    pty.reset();
    std::filesystem::remove(folder / "adapter");
  }
  void start() {
    link = can::make_can_link("slcan:" + (folder / "adapter"), 500000, "lift", context, runtime, log);
    link->start(diary, kEverything);
  }
  /// Runs link and adapter until `condition` holds.
  template <typename Condition>
  [[nodiscard]] bool await(Condition condition) {
    return run_until(context, [&] {
      if (pty) {
        const std::string answer = adapter.hear(pty->read());
        if (!answer.empty()) pty->write(answer);
      }
      return condition();
    });
  }

  Folder folder;
  boost::asio::io_context context;
  AsioRuntime runtime{context};
  Log log;
  LawicelAdapter adapter;
  std::unique_ptr<Pty> pty;
  CanDiary diary;
  std::unique_ptr<can::CanLink> link;
};

TEST_F(SlcanLinkPtyTest, frames_pass_both_ways) {
  plug_in();
  start();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_TRUE(adapter.open());
  EXPECT_EQ(adapter.rate(), '6');
  link->send(frame_of(0x603, 0x40), false);
  ASSERT_TRUE(await([&] { return !adapter.transmitted.empty(); }));
  EXPECT_THAT(adapter.transmitted, ElementsAre("t603140"));
  pty->write("t583160\r");
  ASSERT_TRUE(await([&] { return !diary.frames.empty(); }));
  EXPECT_EQ(diary.frames[0], frame_of(0x583, 0x60));
}

TEST_F(SlcanLinkPtyTest, an_adapter_that_acknowledges_nothing_works) {
  adapter.acknowledges = false;
  plug_in();
  start();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  // One after the other: frames that a machine which stands still keeps waiting count as an overloaded bus.
  for (Byte i = 0; i < 20; ++i) {
    link->send(frame_of(0x100, i), false);
    ASSERT_TRUE(await([&] { return adapter.transmitted.size() == i + 1U; }));
  }
  EXPECT_EQ(adapter.transmitted.back(), "t100113");
}

TEST_F(SlcanLinkPtyTest, an_adapter_plugged_in_later_is_picked_up_and_one_pulled_out_is_told) {
  start();
  context.poll();
  EXPECT_TRUE(diary.told.empty());
  plug_in();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  pull_out();
  adapter = LawicelAdapter();
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("adapter"));
  plug_in();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_EQ(diary.told.size(), 3);
  EXPECT_EQ(link->trouble().reconnects, 1);
}

TEST_F(SlcanLinkPtyTest, a_bus_off_is_told_and_cured_by_opening_the_channel_anew) {
  plug_in();
  start();
  ASSERT_TRUE(await([&] { return diary.up(); }));
  // The status is asked for before any frame is sent and answered first: so refusals are known to be of frames.
  adapter.bus_off = true;
  ASSERT_TRUE(await([&] {
    if (diary.up()) link->send(frame_of(1), false);
    return diary.down();
  }));
  EXPECT_EQ(link->trouble().bus_offs, 1);
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_FALSE(adapter.bus_off);
}

}  // namespace
}  // namespace axisgate::test
