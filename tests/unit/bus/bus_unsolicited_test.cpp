// SPDX-License-Identifier: Apache-2.0
// What drives say unasked: whose it is, in what order, and what it ends.
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using bus::UnsolicitedEvent;
using testing::ElementsAre;
using testing::SizeIs;

using BusUnsolicited = BusStage;

UnsolicitedEvent unsolicited_of(std::uint8_t node, UnsolicitedEvent::Kind kind) {
  UnsolicitedEvent unsolicited;
  unsolicited.node = node;
  unsolicited.kind = kind;
  return unsolicited;
}

TEST_F(BusUnsolicited, reaches_the_drive_of_that_number_alone) {
  link_up();
  wire->events->on_unsolicited(unsolicited_of(9, UnsolicitedEvent::Kind::started));
  wire->events->on_unsolicited(unsolicited_of(2, UnsolicitedEvent::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 2: unsolicited 0"));
}

TEST_F(BusUnsolicited, a_restart_ends_the_exchange_with_that_drive_at_once_and_nothing_else_does) {
  link_up();
  submit(0);
  turn();
  diary.clear();
  wire->events->on_unsolicited(unsolicited_of(2, UnsolicitedEvent::Kind::started));
  wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::values));
  EXPECT_EQ(wire->abandoned, 0);
  wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::started));
  EXPECT_EQ(wire->abandoned, 1);
  EXPECT_THAT(diary, ElementsAre("drive 2: unsolicited 0", "drive 1: unsolicited 3", "drive 1: link lost",
                                 "drive 1: unsolicited 0"));
}

TEST_F(BusUnsolicited, heard_while_a_drive_is_called_wait_in_their_order) {
  link_up();
  drives[0].unsolicited_hook = [&](const UnsolicitedEvent& unsolicited) {
    if (unsolicited.kind != UnsolicitedEvent::Kind::started) return;
    wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::present));
    wire->events->on_unsolicited(unsolicited_of(2, UnsolicitedEvent::Kind::present));
    diary.push_back("drive 1: returns");
  };
  wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 1: unsolicited 0", "drive 1: returns", "drive 1: unsolicited 1",
                                 "drive 2: unsolicited 1"));
}

TEST_F(BusUnsolicited, a_flood_costs_old_process_data_and_nothing_else) {
  link_up();
  drives[0].unsolicited_hook = [&](const UnsolicitedEvent& unsolicited) {
    if (unsolicited.kind != UnsolicitedEvent::Kind::started) return;
    wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::emergency));
    for (std::size_t i = 0; i < 2 * bus::kMaxUnsolicited; ++i)
      wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::values));
    wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::gone));
  };
  wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::started));
  runtime.advance_by(1ms);
  EXPECT_THAT(diary, SizeIs(1 + bus::kMaxUnsolicited)) << "bounded";
  EXPECT_EQ(diary[1], "drive 1: unsolicited 4") << "the emergency";
  EXPECT_EQ(diary.back(), "drive 1: unsolicited 2") << "gone";
}

TEST_F(BusUnsolicited, none_outlives_the_link) {
  link_up();
  drives[0].unsolicited_hook = [&](const UnsolicitedEvent& unsolicited) {
    if (unsolicited.kind != UnsolicitedEvent::Kind::started) return;
    wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::present));
    wire->down("gone");
  };
  wire->events->on_unsolicited(unsolicited_of(1, UnsolicitedEvent::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 1: unsolicited 0", "drive 1: link down", "drive 2: link down"));
}

}  // namespace
}  // namespace axisgate::test
