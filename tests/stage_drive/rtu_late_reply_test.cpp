// SPDX-License-Identifier: Apache-2.0
// Late replies on Modbus RTU, whose replies to a read name nothing but their length: the whole core against simulated
// lines, over the lateness that was measured to give wrong values without a resynchronisation read (210 to 900 ms after
// a timeout of 200 ms). Positions move all the time, so that a reply to another request is another number.
#include <gmock/gmock.h>

#include "tests/stage_drive/rtu_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using testing::IsEmpty;

/// An exchange given up takes 220 ms. The neighbours then have as much time before the next one; only a stop of the
/// late drive goes before them each time, with its three tries and the reads that confirm them.
constexpr Duration kLost = 220ms;

/// Which replies of the drive under test are late.
enum class Late : std::uint8_t { one, three_in_a_row, every_fifth, every_tenth, of_the_position, of_the_state };

std::string late_name(Late late) {
  static const std::vector<std::string> names{"One",        "ThreeInARow",   "EveryFifth",
                                              "EveryTenth", "OfThePosition", "OfTheState"};
  return names[static_cast<std::size_t>(late)];
}

bool strikes(Late late, std::size_t nth, const RtuRequest& request, const RtuRig& rig) {
  switch (late) {
    case Late::one:
      return nth == 7;
    case Late::three_in_a_row:
      return nth >= 7 && nth < 10;
    case Late::every_fifth:
      return nth % 5 == 0;
    case Late::every_tenth:
      return nth % 10 == 0;
    case Late::of_the_position:
      return !request.write && request.covers(rig.position_register());
    case Late::of_the_state:
      return !request.write && request.covers(rig.state_register());
  }
  return false;
}

/// Four seconds of it, with a client that asks things and stops the axis in the middle; then it is left in peace.
void make_late(RtuRig& rig, Late late, int by) {
  rig.come_up_running();
  rig.faults().late_by = std::chrono::milliseconds(by);
  std::size_t nth = 0;
  rig.on_request = [&](const RtuRequest& request) {
    if (request.unit == 1 && strikes(late, ++nth, request, rig)) rig.faults().next(DriveFault::late);
  };
  for (int i = 0; i < 16; ++i) {
    rig.run(250ms);
    rig.ask_something();
    if (i == 8) static_cast<void>(rig.stage.begin(1, with_command(Command::quick_stop)));
  }
  rig.on_request = [](const RtuRequest&) {};
}

bool comes_back(RtuRig& rig) {
  return rig.run_until([&] { return rig.online() && rig.axis()[Quantity::position_actual].valid; }, 45s);
}

using Case = std::tuple<Subject, Late, int>;

std::string case_name(const testing::TestParamInfo<Case>& of) {
  const auto [kind, late, by] = of.param;
  return name(kind) + late_name(late) + std::to_string(by) + "MsLate";
}

class RtuLateReply : public testing::TestWithParam<Case> {};

TEST_P(RtuLateReply, ShowsNoWrongValueWritesNothingButStopsAndComesBack) {
  const auto [kind, late, by] = GetParam();
  RtuRig rig(kind);
  make_late(rig, late, by);
  EXPECT_TRUE(comes_back(rig));
  rig.run(1s);
  EXPECT_THAT(rig.wrongs(), IsEmpty());
  // A drive whose state is mute is stopped: that stop looks for the state, before all else, for its 3 s.
  const int lost_in_a_row = late == Late::one ? 2 : late == Late::of_the_state ? 15 : 6;
  EXPECT_LE(rig.longest_wait(), lost_in_a_row * kLost) << "a neighbour waits";
  EXPECT_GT(rig.looked_at(), 50U);
}

const auto kAllPatterns = testing::Values(Late::one, Late::three_in_a_row, Late::every_fifth, Late::every_tenth,
                                          Late::of_the_position, Late::of_the_state);

INSTANTIATE_TEST_SUITE_P(WithinWorstReply, RtuLateReply,
                         testing::Combine(testing::ValuesIn(kOnRtu), kAllPatterns,
                                          testing::Values(210, 260, 300, 400, 500)),
                         case_name);

// Beyond the profile's worst_reply of 500 ms: a single late reply is met by the resynchronisation read, which is
// answered in order, or by the silence, which counts from the last resynchronisation read given up.
INSTANTIATE_TEST_SUITE_P(ASingleOneBeyond, RtuLateReply,
                         testing::Combine(testing::ValuesIn(kOnRtu), testing::Values(Late::one),
                                          testing::Values(700, 900)),
                         case_name);

// A drive that says each reply twice as well: what was late may come once more behind the read that asked after it.
class RtuLateReplySaidTwice : public testing::TestWithParam<Case> {};

TEST_P(RtuLateReplySaidTwice, ShowsNoWrongValueAndComesBack) {
  const auto [kind, late, by] = GetParam();
  RtuRig rig(kind);
  rig.faults().set_rate(DriveFault::duplicate, 1);
  make_late(rig, late, by);
  EXPECT_TRUE(comes_back(rig));
  rig.run(1s);
  EXPECT_THAT(rig.wrongs(), IsEmpty());
  EXPECT_GT(rig.looked_at(), 50U);
}

INSTANTIATE_TEST_SUITE_P(Every, RtuLateReplySaidTwice,
                         testing::Combine(testing::ValuesIn(kOnRtu), kAllPatterns,
                                          testing::Values(210, 300, 500, 700, 900, 1000, 1100, 1300, 1500, 1750, 2000,
                                                          2550, 3500)),
                         case_name);

// Far beyond: several of them queue up in the drive, and come after the timeout and the silence together. They are
// counted out: whatever the drive owes, for however long, is taken for the answer to nothing else.
class RtuVeryLateReply : public testing::TestWithParam<Case> {};

TEST_P(RtuVeryLateReply, ShowsNoWrongValueHoweverLongOneWasOwed) {
  const auto [kind, late, by] = GetParam();
  RtuRig rig(kind);
  make_late(rig, late, by);
  EXPECT_TRUE(comes_back(rig));
  rig.run(1s);
  EXPECT_THAT(rig.wrongs(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Beyond, RtuVeryLateReply,
                         testing::Combine(testing::ValuesIn(kOnRtu), kAllPatterns,
                                          testing::Values(700, 900, 1000, 1100, 1300, 1750, 2550)),
                         case_name);

}  // namespace
}  // namespace axisgate::test
