// SPDX-License-Identifier: Apache-2.0
// Design 7, Mute objects: each object of each drive on each protocol mute in turn, from the start and while online; a
// motion that needs what is mute; and what is refused for now.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/stage/stage_lines.hpp"
#include "tests/unit/drive/drive_table_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Ge;
using testing::Le;
using Place = simulated::DriveFaults::Place;

constexpr std::array kEach{Subject::id286pro,       Subject::jd_rtu,        Subject::md_rtu,
                           Subject::leadshine,      Subject::jd_can,        Subject::md_can,
                           Subject::jd_serial,      Subject::md_serial,     Subject::keya_can_speed,
                           Subject::keya_rs232_speed, Subject::keya_rs485_speed, Subject::keya_canopen_speed};

bool asks_by_code(Subject s) { return s == Subject::keya_rs232_speed || s == Subject::keya_rs485_speed; }

simulated::DriveFaults& faults(TableRig& rig) {
  return *rig.stage.at_link(0, [](auto& link) { return &link.line().faults(0); });
}

const drive::DriveModel& model(TableRig& rig) { return rig.stage.gateway().drive_of(1)->model(); }

Place place_of(Subject subject, const bus::ObjectAddress& address) {
  if (asks_by_code(subject)) return {static_cast<std::uint16_t>(address.index & 0xFF), 0};
  return {address.index, address.sub};
}

struct Readable {
  std::string name;
  Place place;
  bool tells_state;  ///< without it there is no axis
  bool unasked;      ///< the drive tells it by itself
};

/// What the profile has of this drive, and on CANopen what the gateway reads beside it; each place once.
std::vector<Readable> readable(Subject subject) {
  TableRig rig(subject);
  std::vector<Readable> out;
  const drive::DriveModel& drive = model(rig);
  const auto add = [&](const std::string& object, Place place, bool tells_state, bool unasked) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Readable& r) { return r.place == place; });
    if (same == out.end())
      out.push_back({object, place, tells_state, unasked});
    else
      *same = {same->name, place, same->tells_state || tells_state, same->unasked || unasked};
  };
  for (std::size_t i = 0; i < drive.objects.size(); ++i) {
    const drive::ObjectDef& object = drive.objects[i];
    if (object.emulated || !object.readable) continue;
    const auto id = static_cast<drive::ObjectId>(i);
    const auto& by_itself = drive.unasked.objects;
    add(object.name, place_of(subject, object.address), drive.needs_for_state(id),
        std::find(by_itself.begin(), by_itself.end(), id) != by_itself.end());
  }
  if (drive::is_canopen(drive)) {
    for (std::uint8_t sub = 1; sub <= 4; ++sub) add("identity", {0x1018, sub}, false, false);
    for (std::uint16_t tpdo = 0; tpdo < 4; ++tpdo) {
      add("TPDO parameter", {static_cast<std::uint16_t>(0x1800 + tpdo), 1}, false, false);
      for (std::uint8_t sub = 0; sub <= 4; ++sub)
        add("TPDO mapping", {static_cast<std::uint16_t>(0x1A00 + tpdo), sub}, false, false);
    }
  }
  return out;
}

bool online(TableRig& rig) { return rig.axis().link_state == LinkState::online; }

std::size_t lines_with(TableRig& rig, const std::string& part) {
  const auto& log = rig.stage.log();
  return static_cast<std::size_t>(
      std::count_if(log.begin(), log.end(), [&](const std::string& line) { return line.find(part) != line.npos; }));
}

class MuteObject : public testing::TestWithParam<Subject> {};

TEST_P(MuteObject, FromTheStartCostsItselfAloneOrIsNamed) {
  for (const Readable& object : readable(GetParam())) {
    SCOPED_TRACE(object.name);
    TableRig rig(GetParam());
    faults(rig).spoil(object.place, {});
    const bool came = rig.stage.run_until([&] { return online(rig); }, 30s);
    if (!object.tells_state) {
      ASSERT_TRUE(came) << "one object keeps the whole axis away";
      continue;
    }
    if (object.unasked) {
      EXPECT_TRUE(came) << "it comes by itself";
      continue;
    }
    ASSERT_FALSE(came);
    // One place of a Keya holds both motors' state.
    EXPECT_THAT(lines_with(rig, "was not answered three times in a row"), AllOf(Ge(1U), Le(2U)))
        << testing::PrintToString(rig.stage.log());
    EXPECT_TRUE(rig.axis().alarms & bit(AxisAlarm::profile_mismatch));
    faults(rig).mend(object.place);
    EXPECT_TRUE(rig.stage.run_until([&] { return online(rig); }, 10s)) << "asked each 2 s, then brought up";
    EXPECT_FALSE(rig.axis().alarms & bit(AxisAlarm::profile_mismatch));
  }
}

TEST_P(MuteObject, WhileOnlineCostsItselfAlone) {
  for (const Readable& object : readable(GetParam())) {
    SCOPED_TRACE(object.name);
    TableRig rig(GetParam());
    rig.online();
    rig.stage.run(2s);
    const std::uint32_t supported = rig.axis().supported;
    const std::uint32_t valid = rig.axis().valid_bits();
    faults(rig).spoil(object.place, {});
    rig.stage.run(60s);
    const bool by_itself = object.unasked || drive::is_canopen(model(rig));
    if (object.tells_state && !by_itself) {
      EXPECT_EQ(rig.axis().link_state, LinkState::setup);
    } else if (!object.tells_state) {
      EXPECT_EQ(rig.axis().link_state, LinkState::online);
    }
    const std::uint64_t before = rig.stage.gateway().bus(0).statistics().timeouts;
    rig.stage.run(60s);
    const std::uint64_t timeouts = rig.stage.gateway().bus(0).statistics().timeouts - before;
    EXPECT_LE(timeouts, object.tells_state ? 60U : 3U) << "asked ever more seldom";
    EXPECT_TRUE(object.tells_state || online(rig));
    EXPECT_EQ(rig.axis().supported & rig.axis().valid_bits() & ~valid, 0U);
    faults(rig).mend(object.place);
    EXPECT_TRUE(rig.stage.run_until(
        [&] { return online(rig) && rig.axis().supported == supported && (valid & ~rig.axis().valid_bits()) == 0; }, 62s));
  }
}

INSTANTIATE_TEST_SUITE_P(EachDrive, MuteObject, testing::ValuesIn(kEach),
                         [](const auto& of) { return name(of.param); });

}  // namespace
}  // namespace axisgate::test
