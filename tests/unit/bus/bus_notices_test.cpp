// What drives say unasked: whose it is, in what order, and what it ends.
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using bus::Notice;
using testing::ElementsAre;
using testing::SizeIs;

using BusNotices = BusStage;

Notice notice_of(std::uint8_t node, Notice::Kind kind) {
  Notice notice;
  notice.node = node;
  notice.kind = kind;
  return notice;
}

TEST_F(BusNotices, reaches_the_drive_of_that_number_alone) {
  link_up();
  wire->events->on_notice(notice_of(9, Notice::Kind::started));
  wire->events->on_notice(notice_of(2, Notice::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 2: notice 0"));
}

TEST_F(BusNotices, a_restart_ends_the_exchange_with_that_drive_at_once_and_nothing_else_does) {
  link_up();
  submit(0);
  turn();
  diary.clear();
  wire->events->on_notice(notice_of(2, Notice::Kind::started));
  wire->events->on_notice(notice_of(1, Notice::Kind::values));
  EXPECT_EQ(wire->abandoned, 0);
  wire->events->on_notice(notice_of(1, Notice::Kind::started));
  EXPECT_EQ(wire->abandoned, 1);
  EXPECT_THAT(diary, ElementsAre("drive 2: notice 0", "drive 1: notice 3", "drive 1: link lost", "drive 1: notice 0"));
}

TEST_F(BusNotices, heard_while_a_drive_is_called_wait_in_their_order) {
  link_up();
  drives[0].notice_hook = [&](const Notice& notice) {
    if (notice.kind != Notice::Kind::started) return;
    wire->events->on_notice(notice_of(1, Notice::Kind::present));
    wire->events->on_notice(notice_of(2, Notice::Kind::present));
    diary.push_back("drive 1: returns");
  };
  wire->events->on_notice(notice_of(1, Notice::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 1: notice 0", "drive 1: returns", "drive 1: notice 1", "drive 2: notice 1"));
}

TEST_F(BusNotices, a_flood_costs_old_process_data_and_nothing_else) {
  link_up();
  drives[0].notice_hook = [&](const Notice& notice) {
    if (notice.kind != Notice::Kind::started) return;
    wire->events->on_notice(notice_of(1, Notice::Kind::emergency));
    for (std::size_t i = 0; i < 2 * bus::kMaxNotices; ++i) wire->events->on_notice(notice_of(1, Notice::Kind::values));
    wire->events->on_notice(notice_of(1, Notice::Kind::gone));
  };
  wire->events->on_notice(notice_of(1, Notice::Kind::started));
  runtime.advance_by(1ms);
  EXPECT_THAT(diary, SizeIs(1 + bus::kMaxNotices)) << "bounded";
  EXPECT_EQ(diary[1], "drive 1: notice 4") << "the emergency";
  EXPECT_EQ(diary.back(), "drive 1: notice 2") << "gone";
}

TEST_F(BusNotices, none_outlives_the_link) {
  link_up();
  drives[0].notice_hook = [&](const Notice& notice) {
    if (notice.kind != Notice::Kind::started) return;
    wire->events->on_notice(notice_of(1, Notice::Kind::present));
    wire->down("gone");
  };
  wire->events->on_notice(notice_of(1, Notice::Kind::started));
  EXPECT_THAT(diary, ElementsAre("drive 1: notice 0", "drive 1: link down", "drive 2: link down"));
}

}  // namespace
}  // namespace axisgate::test
