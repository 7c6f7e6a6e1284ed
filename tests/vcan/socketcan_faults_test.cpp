// SPDX-License-Identifier: Apache-2.0
// Error frames as a controller's driver hands them over; vcan has no controller, so a peer writes them.
#include "tests/vcan/vcan_stage.hpp"

namespace axisgate::test {
namespace {

using testing::HasSubstr;

class SocketCanFaultsTest : public VcanStage {
 protected:
  void SetUp() override {
    VcanStage::SetUp();
    start_all();
  }
};

TEST_F(SocketCanFaultsTest, bus_off_is_told_at_once_and_its_end_with_the_restart) {
  peer->send_error(CAN_ERR_BUSOFF);
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr(interface + ": bus-off"));
  EXPECT_EQ(link->trouble().bus_offs, 1);
  peer->send_error(CAN_ERR_RESTARTED);
  ASSERT_TRUE(await([&] { return diary.up(); }));
  EXPECT_EQ(diary.told.size(), 3);
  EXPECT_EQ(link->trouble().reconnects, 1);
}

TEST_F(SocketCanFaultsTest, while_bus_off_nothing_is_sent_and_nothing_handed_over) {
  peer->send_error(CAN_ERR_BUSOFF);
  ASSERT_TRUE(await([&] { return diary.down(); }));
  link->send(frame_of(1), false);
  peer->send(frame_of(2));
  peer->send_error(CAN_ERR_RESTARTED);
  peer->send(frame_of(3));
  ASSERT_TRUE(await([&] { return !diary.frames.empty(); }));
  EXPECT_EQ(diary.frames[0].id, 3);
  link->send(frame_of(4), false);
  ASSERT_TRUE(await_heard(1));
  EXPECT_EQ(heard[0].can_id, 4);
}

TEST_F(SocketCanFaultsTest, after_too_many_bus_offs_it_stays_down_until_the_interface_is_taken_down_and_up) {
  for (int i = 0; i < 6; ++i) {
    peer->send_error(CAN_ERR_BUSOFF);
    ASSERT_TRUE(await([&] { return diary.down(); }));
    peer->send_error(CAN_ERR_RESTARTED);
    ASSERT_TRUE(i == 5 || await([&] { return diary.up(); })) << i;
  }
  EXPECT_THAT(diary.told.back(), HasSubstr("more than 5 times in a minute"));
  const std::size_t told = diary.told.size();
  const std::uint32_t seen = link->trouble().error_frames;
  peer->send_error(CAN_ERR_LOSTARB);
  ASSERT_TRUE(await([&] { return link->trouble().error_frames >= seen + 2; }));
  EXPECT_EQ(diary.told.size(), told) << "the restart changes nothing now";
  take_down();
  take_up();
  ASSERT_TRUE(await([&] { return diary.up(); }));
}

TEST_F(SocketCanFaultsTest, a_bus_where_nobody_acknowledges_is_told_and_a_frame_ends_it) {
  peer->send_error(CAN_ERR_CRTL | CAN_ERR_ACK, CAN_ERR_CRTL_TX_PASSIVE);
  // Without a controller that goes on complaining, half a second is all that is seen of it.
  ASSERT_TRUE(await([&] { return diary.down(); }));
  EXPECT_THAT(diary.told.back(), HasSubstr("nobody acknowledges"));
  peer->send(frame_of(1));
  ASSERT_TRUE(await([&] { return diary.frames.size() == 1; }));
  EXPECT_TRUE(diary.up());
  EXPECT_EQ(link->trouble().no_ack, 1);
  EXPECT_EQ(link->trouble().error_passive, 1);
}

TEST_F(SocketCanFaultsTest, a_controller_that_complains_no_more_is_used_again) {
  peer->send_error(CAN_ERR_CRTL | CAN_ERR_ACK, CAN_ERR_CRTL_TX_PASSIVE);
  ASSERT_TRUE(await([&] { return diary.down(); }));
  ASSERT_TRUE(await([&] { return diary.up(); }));
}

TEST_F(SocketCanFaultsTest, errors_that_the_controller_copes_with_are_counted_and_borne) {
  for (const canid_t classes : {CAN_ERR_LOSTARB, CAN_ERR_PROT, CAN_ERR_BUSERROR, CAN_ERR_ACK, CAN_ERR_TRX}) {
    peer->send_error(classes);
  }
  peer->send_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  peer->send_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING);
  settle();
  EXPECT_TRUE(diary.up());
  EXPECT_EQ(link->trouble().error_frames, 7);
  EXPECT_EQ(link->trouble().no_ack, 1);
  EXPECT_EQ(link->trouble().lost_in, 1);
}

TEST_F(SocketCanFaultsTest, error_frames_are_never_handed_over_as_frames) {
  for (int i = 0; i < 20; ++i) peer->send_error(CAN_ERR_LOSTARB);
  settle();
  EXPECT_TRUE(diary.frames.empty());
}

}  // namespace
}  // namespace axisgate::test
