// SPDX-License-Identifier: Apache-2.0
// Design 7, Mute objects: each object of each drive on each protocol mute in turn, from the start and while online; a
// motion that needs what is mute; and what is refused for now.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/stage/stage_lines.hpp"
#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Ge;
using testing::Le;
using Place = simulated::DriveFaults::Place;

constexpr std::array kEach{Subject::id286pro,         Subject::jd_rtu,           Subject::md_rtu,
                           Subject::leadshine,        Subject::jd_can,           Subject::md_can,
                           Subject::jd_serial,        Subject::md_serial,        Subject::keya_can_speed,
                           Subject::keya_rs232_speed, Subject::keya_rs485_speed, Subject::keya_canopen_speed};

bool asks_by_code(Subject s) { return s == Subject::keya_rs232_speed || s == Subject::keya_rs485_speed; }

const model::DriveModel& model(DriveRig& rig) { return rig.stage.gateway().drive_of(1)->model(); }

Place place_of(Subject subject, const ObjectAddress& address) {
  if (asks_by_code(subject)) return {static_cast<std::uint16_t>(address.index & 0xFF), 0};
  return {address.index, address.sub};
}

struct Readable {
  std::string name;
  Place place;
  bool tells_state;  ///< without it there is no axis
  bool unsolicited;  ///< the drive tells it by itself
};

/// What the profile has of this drive, and on CANopen what the gateway reads beside it; each place once.
std::vector<Readable> readable(Subject subject) {
  DriveRig rig(subject);
  std::vector<Readable> out;
  const model::DriveModel& drive = model(rig);
  const auto add = [&](const std::string& object, Place place, bool tells_state, bool unsolicited) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Readable& r) { return r.place == place; });
    if (same == out.end())
      out.push_back({object, place, tells_state, unsolicited});
    else
      *same = {same->name, place, same->tells_state || tells_state, same->unsolicited || unsolicited};
  };
  for (std::size_t i = 0; i < drive.objects.size(); ++i) {
    const model::ObjectDef& object = drive.objects[i];
    if (object.emulated || !object.readable) continue;
    const auto id = static_cast<model::ObjectId>(i);
    const auto& by_itself = drive.unsolicited.objects;
    add(object.name, place_of(subject, object.address), drive.needs_for_state(id),
        std::find(by_itself.begin(), by_itself.end(), id) != by_itself.end());
  }
  if (model::is_canopen(drive)) {
    for (std::uint8_t sub = 1; sub <= 4; ++sub) add("identity", {0x1018, sub}, false, false);
    for (std::uint16_t tpdo = 0; tpdo < 4; ++tpdo) {
      add("TPDO parameter", {static_cast<std::uint16_t>(0x1800 + tpdo), 1}, false, false);
      for (std::uint8_t sub = 0; sub <= 4; ++sub)
        add("TPDO mapping", {static_cast<std::uint16_t>(0x1A00 + tpdo), sub}, false, false);
    }
  }
  return out;
}

bool online(DriveRig& rig) { return rig.axis().link_state == LinkState::online; }

class MuteObject : public testing::TestWithParam<Subject> {};

TEST_P(MuteObject, FromTheStartCostsItselfAloneOrIsNamed) {
  for (const Readable& object : readable(GetParam())) {
    SCOPED_TRACE(object.name);
    DriveRig rig(GetParam());
    rig.faults().spoil(object.place, {});
    const bool came = rig.stage.run_until([&] { return online(rig); }, 30s);
    if (!object.tells_state) {
      ASSERT_TRUE(came) << "one object keeps the whole axis away";
      continue;
    }
    if (object.unsolicited) {
      EXPECT_TRUE(came) << "it comes by itself";
      continue;
    }
    ASSERT_FALSE(came);
    // One place of a Keya holds both motors' state.
    EXPECT_THAT(rig.times_told("was not answered three times in a row"), AllOf(Ge(1U), Le(2U)))
        << testing::PrintToString(rig.stage.log());
    EXPECT_TRUE(rig.axis().alarms & bit(AxisAlarm::profile_mismatch));
    rig.faults().mend(object.place);
    EXPECT_TRUE(rig.stage.run_until([&] { return online(rig); }, 10s)) << "asked each 2 s, then brought up";
    EXPECT_FALSE(rig.axis().alarms & bit(AxisAlarm::profile_mismatch));
  }
}

TEST_P(MuteObject, WhileOnlineCostsItselfAlone) {
  for (const Readable& object : readable(GetParam())) {
    SCOPED_TRACE(object.name);
    DriveRig rig(GetParam());
    rig.online();
    rig.stage.run(2s);
    const std::uint32_t supported = rig.axis().supported;
    const std::uint32_t valid = rig.axis().valid_bits();
    rig.faults().spoil(object.place, {});
    rig.stage.run(60s);
    const bool by_itself = object.unsolicited || model::is_canopen(model(rig));
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
    rig.faults().mend(object.place);
    EXPECT_TRUE(rig.stage.run_until(
        [&] { return online(rig) && rig.axis().supported == supported && (valid & ~rig.axis().valid_bits()) == 0; },
        62s));
  }
}

// Whose end, limits and stop are told by what is mute: nobody can answer for it any more.
TEST_P(MuteObject, ThatAMotionNeedsStopsTheMotor) {
  for (const Readable& object : readable(GetParam())) {
    const bool position = object.name == "position_actual" || object.name == "A.position";
    if ((!object.tells_state && !position) || object.unsolicited) continue;
    DriveRig rig(GetParam());
    if (model::is_canopen(model(rig))) continue;  // both come by TPDO, whoever reads them or not
    SCOPED_TRACE(object.name);
    rig.online();
    ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
    ASSERT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
    rig.stage.run(1s);
    ASSERT_TRUE(rig.turns());
    rig.faults().spoil(object.place, {});
    EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 15s)) << "it turns on, and nobody sees it";
    EXPECT_GE(rig.times_told("is told no more, and the motion needs it"), 1U);
    rig.faults().mend(object.place);
    EXPECT_TRUE(rig.stage.run_until([&] { return online(rig); }, 62s));
    rig.stage.run(2s);
    EXPECT_FALSE(rig.turns()) << "nothing resumes";
  }
}

INSTANTIATE_TEST_SUITE_P(EachDrive, MuteObject, testing::ValuesIn(kEach), named);

// A drive that has just started, or is busy, refuses what it has.
using Refused = std::tuple<Subject, std::uint32_t>;
class RefusedForNow : public testing::TestWithParam<Refused> {};

TEST_P(RefusedForNow, IsBackWithoutARestart) {
  const auto [subject, code] = GetParam();
  for (const Readable& object : readable(subject)) {
    SCOPED_TRACE(object.name);
    DriveRig whole(subject);
    whole.online();
    whole.stage.run(2s);
    DriveRig rig(subject);
    rig.faults().spoil(object.place, {.refused_with = code});
    rig.stage.run(4s);
    rig.faults().mend(object.place);
    const auto as_it_should_be = [&] {
      return online(rig) && rig.axis().supported == whole.axis().supported &&
             (whole.axis().valid_bits() & ~rig.axis().valid_bits()) == 0;
    };
    EXPECT_TRUE(rig.stage.run_until(as_it_should_be, 10s));
  }
}

std::string refused_name(const testing::TestParamInfo<Refused>& of) {
  return name(std::get<0>(of.param)) + "With" + std::to_string(std::get<1>(of.param));
}

INSTANTIATE_TEST_SUITE_P(Rtu, RefusedForNow,
                         testing::Combine(testing::Values(Subject::id286pro, Subject::jd_rtu), testing::Values(4, 6)),
                         refused_name);
INSTANTIATE_TEST_SUITE_P(ByAbort, RefusedForNow,
                         testing::Combine(testing::Values(Subject::leadshine, Subject::jd_can, Subject::jd_serial,
                                                          Subject::keya_canopen_speed),
                                          testing::Values(0x08000000U, 0x06060000U, 0x08000023U, 0x06040043U)),
                         refused_name);

// What makes a Leadshine notice a dead gateway, and a Kinco send its heartbeat: refused until after it came online.
TEST(RefusedSetup, IsWrittenWhenTheDriveTakesIt) {
  for (const auto& [subject, place] :
       {std::pair{Subject::leadshine, Place{0x1016, 1}}, {Subject::jd_can, Place{0x1017, 0}}}) {
    SCOPED_TRACE(name(subject));
    DriveRig rig(subject);
    rig.faults().spoil(place, {.refused_with = 0x08000022, .writes_too = true});
    ASSERT_TRUE(rig.stage.run_until([&] { return online(rig); }, 20s));
    rig.stage.run(5s);
    rig.faults().mend(place);
    const auto held = [&] {
      const auto bytes = rig.stage.can_node(0).peek({place.first, place.second}, {});
      return bytes && simulated::little_endian(*bytes) != 0;
    };
    EXPECT_FALSE(held());
    EXPECT_TRUE(rig.stage.run_until(held, 62s));
    rig.stage.run(1s);
    EXPECT_TRUE(online(rig));
    EXPECT_FALSE(rig.axis().alarms & bit(AxisAlarm::no_comm_watchdog)) << testing::PrintToString(rig.stage.log());
  }
}

TEST(RefusedSetup, IsNotWrittenOverWhatAClientHasWrittenSince) {
  constexpr std::int64_t kRamp = 12'345;
  DriveRig rig(Subject::leadshine);
  const Place deceleration{0x6084, 0};
  rig.faults().spoil(deceleration, {.refused_with = 0x08000022, .writes_too = true, .reads = false});
  ASSERT_TRUE(rig.stage.run_until([&] { return online(rig); }, 20s));
  rig.faults().mend(deceleration);
  ASSERT_EQ(rig.stage.write(1, Quantity::profile_deceleration, kRamp).outcome.code, Errc::ok);
  rig.stage.run(62s);
  EXPECT_EQ(rig.axis()[Quantity::profile_deceleration].value, kRamp);
}

// Until it has answered anything, "there is no such object" says nothing of the drive.
TEST(RefusedAtItsStart, ByADriveThatStillStartsIsNotForEver) {
  for (const Subject subject : {Subject::id286pro, Subject::jd_rtu, Subject::leadshine, Subject::jd_serial}) {
    SCOPED_TRACE(name(subject));
    DriveRig rig(subject);
    const bool by_code = subject == Subject::id286pro || subject == Subject::jd_rtu;
    const std::uint32_t not_there = by_code ? 2 : 0x06020000;
    const std::vector<Readable> all = readable(subject);
    for (const Readable& object : all) rig.faults().spoil(object.place, {.refused_with = not_there});
    rig.stage.run(3s);
    for (const Readable& object : all) rig.faults().mend(object.place);
    EXPECT_TRUE(rig.stage.run_until([&] { return online(rig); }, 10s));
    rig.stage.run(1s);
    EXPECT_NE(rig.axis().supported & bit(Quantity::position_actual), 0U);
  }
}

}  // namespace
}  // namespace axisgate::test
