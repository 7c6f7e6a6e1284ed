// What `--line` understands, and what it says to what it does not.
#include "tests/axisgate_sim/line_spec.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace axisgate::simulated {
namespace {

TEST(LineSpec, NamesThePathTheLineAndItsDrives) {
  const LineSpec spec = parse_line_spec("/tmp/a:b/table:md@1,jd@2+fresh+home=-10..20", {});
  EXPECT_EQ(spec.path, "/tmp/a:b/table");
  EXPECT_EQ(spec.name, "table");
  ASSERT_EQ(spec.drives.size(), 2U);
  EXPECT_EQ(spec.drives[0].type, KincoType::md);
  EXPECT_FALSE(spec.drives[0].factory_fresh);
  EXPECT_EQ(spec.drives[1].station, 2);
  EXPECT_TRUE(spec.drives[1].factory_fresh);
  EXPECT_EQ(spec.drives[1].mechanics.home_from, -10);
  EXPECT_EQ(spec.drives[1].mechanics.home_to, 20);
  EXPECT_EQ(spec.kind, LineKind::kinco);
  EXPECT_EQ(spec.describe(), "md@1,jd@2");
}

TEST(LineSpec, NamesAModbusRtuLineAndItsDrives) {
  DriveOptions common;
  common.boot_time = std::chrono::milliseconds(7);
  const LineSpec spec =
      parse_line_spec("/tmp/axes:rtu:id286pro@1+400=11+319=-5000+home=5..9,jd@2+errors=83,md@3+fresh", common);
  EXPECT_EQ(spec.path, "/tmp/axes");
  EXPECT_EQ(spec.name, "axes");
  EXPECT_EQ(spec.kind, LineKind::rtu);
  EXPECT_TRUE(spec.drives.empty());
  ASSERT_EQ(spec.rtu_drives.size(), 3U);
  const auto& stepper = std::get<Id286proOptions>(spec.rtu_drives[0]);
  EXPECT_TRUE(stepper.internal_pulses);
  EXPECT_THAT(stepper.stored, testing::ElementsAre(testing::Pair(319, -5000), testing::Pair(400, 11)));
  EXPECT_EQ(stepper.mechanics.home_to, 9);
  EXPECT_EQ(stepper.boot_time, common.boot_time);
  const auto& jd = std::get<KincoRtuDrive>(spec.rtu_drives[1]);
  EXPECT_EQ(jd.drive.type, KincoType::jd);
  EXPECT_EQ(jd.rtu.read_error_function, 0x83);
  EXPECT_TRUE(std::get<KincoRtuDrive>(spec.rtu_drives[2]).drive.factory_fresh);
  EXPECT_EQ(spec.describe(), "rtu:id286pro@1,jd@2,md@3");
  EXPECT_THAT(spec.stations(), testing::ElementsAre(1, 2, 3));
  EXPECT_FALSE(
      std::get<Id286proOptions>(parse_line_spec("/x:rtu:id286pro@254+fresh", {}).rtu_drives[0]).internal_pulses);
}

TEST(LineSpec, NamesACanInterfaceOrAnAdapterAndTheirDrives) {
  const LineSpec spec = parse_line_spec("vcan0:can:ld2@1+2008.00=5000+ack,jd@2+short,md@127+block+limits=-9..9", {});
  EXPECT_EQ(spec.path, "vcan0");
  EXPECT_EQ(spec.name, "vcan0");
  EXPECT_EQ(spec.kind, LineKind::can);
  ASSERT_EQ(spec.can_drives.size(), 3U);
  const auto& ld2 = std::get<LeadshineOptions>(spec.can_drives[0]);
  EXPECT_THAT(ld2.stored, testing::ElementsAre(testing::Pair(ObjectKey{0x2008, 0}, 5000)));
  EXPECT_TRUE(ld2.acknowledges_setpoints);
  EXPECT_TRUE(std::get<KincoCanDrive>(spec.can_drives[1]).can.short_frames);
  EXPECT_TRUE(std::get<KincoCanDrive>(spec.can_drives[2]).can.block);
  EXPECT_EQ(std::get<KincoCanDrive>(spec.can_drives[2]).drive.mechanics.positive_limit, 9);
  EXPECT_EQ(spec.describe(), "can:ld2@1,jd@2,md@127");
  const LineSpec serial = parse_line_spec("/tmp/adapter:lawicel:ld2@9", {});
  EXPECT_EQ(serial.path, "/tmp/adapter");
  EXPECT_EQ(serial.name, "adapter");
  EXPECT_EQ(serial.kind, LineKind::lawicel);
  EXPECT_EQ(serial.describe(), "lawicel:ld2@9");
}

TEST(LineSpec, NamesKeyaDrivesOnEachOfTheirInterfaces) {
  const LineSpec rs232 = parse_line_spec("/tmp/cart:keya-rs232+0020=3+heartbeat=50+ramp", {});
  EXPECT_EQ(rs232.path, "/tmp/cart");
  EXPECT_EQ(rs232.kind, LineKind::keya_rs232);
  ASSERT_EQ(rs232.keya_drives.size(), 1U);
  EXPECT_THAT(rs232.keya_drives[0].parameters, testing::ElementsAre(testing::Pair(20, 3)));
  EXPECT_EQ(rs232.keya_drives[0].heartbeat, std::chrono::milliseconds(50));
  EXPECT_EQ(rs232.keya_drives[0].loss_stop, KeyaStop::ramp);
  EXPECT_EQ(rs232.describe(), "keya-rs232@1");
  const LineSpec rs485 = parse_line_spec("/tmp/carts:keya-rs485@1,keya-rs485@200+other-kept+zero-ignored", {});
  EXPECT_EQ(rs485.kind, LineKind::keya_rs485);
  EXPECT_THAT(rs485.stations(), testing::ElementsAre(1, 200));
  EXPECT_FALSE(rs485.keya_drives[1].code_disables_other);
  EXPECT_FALSE(rs485.keya_drives[1].enable_with_zero_moves);
  const LineSpec can = parse_line_spec("vcan0:keya-can@2+sub-00+queries-feed+repeat-ignored,ld2@3", {});
  EXPECT_EQ(can.kind, LineKind::can);
  EXPECT_EQ(can.describe(), "can:keya-can@2,ld2@3");
  const auto& own = std::get<KeyaCanDrive>(can.can_drives[0]).drive;
  EXPECT_FALSE(own.echoes_sub);
  EXPECT_TRUE(own.queries_feed_watchdog);
  EXPECT_FALSE(own.repeated_move_moves);
  const LineSpec adapter = parse_line_spec("/tmp/adapter:lawicel:keya-kydas4860-2e@7+period-only+keeps-counts", {});
  EXPECT_EQ(adapter.kind, LineKind::lawicel);
  EXPECT_EQ(adapter.describe(), "lawicel:keya-kydas4860-2e@7");
  EXPECT_FALSE(std::get<KeyaCanopenDrive>(adapter.can_drives[0]).drive.pdo_on_change);
  EXPECT_TRUE(std::get<KeyaCanopenDrive>(adapter.can_drives[0]).drive.keeps_counts);
}

TEST(LineSpec, SaysWhatToChange) {
  const auto message = [](const char* text) -> std::string {
    try {
      (void)parse_line_spec(text, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message("/tmp/lift"), HasSubstr("PATH:DRIVES"));
  EXPECT_THAT(message("/tmp/:jd@1"), HasSubstr("name the link"));
  EXPECT_THAT(message("/tmp/x:abc@1"), HasSubstr("type jd or md"));
  EXPECT_THAT(message("/tmp/x:jd@0"), HasSubstr("1 to 127"));
  EXPECT_THAT(message("/tmp/x:jd@1,md@1"), HasSubstr("already on the line"));
  EXPECT_THAT(message("/tmp/x:jd@1+old"), HasSubstr("use fresh"));
  EXPECT_THAT(message("/tmp/x:jd@1+home=5"), HasSubstr("FROM..TO"));
  EXPECT_THAT(message("/tmp/x:id286pro@1"), HasSubstr("type jd or md"));
  EXPECT_THAT(message("/tmp/x:rtu:abc@1"), HasSubstr("type jd, md or id286pro"));
  EXPECT_THAT(message("/tmp/x:rtu:jd@128"), HasSubstr("1 to 127"));
  EXPECT_THAT(message("/tmp/x:rtu:id286pro@255"), HasSubstr("1 to 254"));
  EXPECT_THAT(message("/tmp/x:rtu:jd@1,id286pro@1"), HasSubstr("already on the line"));
  EXPECT_THAT(message("/tmp/x:rtu:jd@1+cascade"), HasSubstr("errors=83"));
  EXPECT_THAT(message("/tmp/x:rtu:id286pro@1+107=1"), HasSubstr("a stored register"));
  EXPECT_THAT(message("/tmp/x:rtu:id286pro@1+400=31"), HasSubstr("a stored register"));
  EXPECT_THAT(message("/tmp/x:rtu:id286pro@1+"), HasSubstr("a stored register"));
  EXPECT_THAT(message("can0:can:id286pro@1"), HasSubstr("type jd, md, ld2, keya-can or keya-kydas4860-2e"));
  EXPECT_THAT(message("can0:can:ld2@1,md@1"), HasSubstr("already on the line"));
  EXPECT_THAT(message("can0:can:ld2@1+9999.00=1"), HasSubstr("a stored object"));
  EXPECT_THAT(message("can0:can:ld2@1+2008=1"), HasSubstr("a stored object"));
  EXPECT_THAT(message("can0:can:jd@1+ack"), HasSubstr("use fresh, block, short"));
  EXPECT_THAT(message("/tmp/x:keya-rs232@2"), HasSubstr("1 to 1"));
  EXPECT_THAT(message("/tmp/x:keya-rs232,keya-rs232"), HasSubstr("already on the line"));
  EXPECT_THAT(message("/tmp/x:keya-rs485"), HasSubstr("1 to 255"));
  EXPECT_THAT(message("/tmp/x:keya-rs485@1,jd@2"), HasSubstr("type keya-rs485"));
  EXPECT_THAT(message("/tmp/x:keya-rs485@1+0020=5"), HasSubstr("0020=3"));
  EXPECT_THAT(message("/tmp/x:keya-rs485@1+20=1"), HasSubstr("0020=3"));
  EXPECT_THAT(message("/tmp/x:keya-rs485@1+"), HasSubstr("use coast, ramp"));
  EXPECT_THAT(message("/dev/can0:can:jd@1"), HasSubstr("at most 15 characters"));
  EXPECT_THAT(message("a-very-long-name:can:jd@1"), HasSubstr("at most 15 characters"));
}

}  // namespace
}  // namespace axisgate::simulated
