// Late replies on Modbus RTU, whose replies to a read name nothing but their length: the whole core against simulated
// lines, over the lateness that was measured to give wrong values without a fence (210 to 900 ms after a timeout of
// 200 ms). Positions move all the time, so that a reply to another request is another number.
#include <gmock/gmock.h>

#include "tests/unit/drive/rtu_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using testing::IsEmpty;

/// Which replies of the drive under test are late.
enum class Late : std::uint8_t { one, three_in_a_row, every_fifth, every_tenth, of_the_position, of_the_state };

std::string name(Late late) {
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

class RtuLateReply : public testing::TestWithParam<std::tuple<RtuKind, Late, int>> {};

TEST_P(RtuLateReply, ShowsNoWrongValueWritesNothingButStopsAndComesBack) {
  const auto [kind, late, by] = GetParam();
  RtuRig rig(kind);
  rig.come_up_running();
  rig.faults().late_by = std::chrono::milliseconds(by);
  std::size_t nth = 0;
  rig.on_request = [&, late = late](const RtuRequest& request) {
    if (request.unit == 1 && strikes(late, ++nth, request, rig)) rig.faults().next(DriveFault::late);
  };
  for (int i = 0; i < 16; ++i) {
    rig.run(250ms);
    rig.ask_something();
    if (i == 8) static_cast<void>(rig.stage.begin(1, with_command(Command::quick_stop)));
  }
  rig.on_request = [](const RtuRequest&) {};
  EXPECT_TRUE(rig.run_until([&] { return rig.online(); }, 45s));
  rig.run(1s);
  EXPECT_TRUE(rig.online());
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_THAT(rig.wrongs(), IsEmpty());
  EXPECT_LE(rig.oldest_of_neighbours(), 300ms);
  EXPECT_GT(rig.looked_at(), 50U);
}

INSTANTIATE_TEST_SUITE_P(
    Table, RtuLateReply,
    testing::Combine(testing::ValuesIn(kRtuKinds),
                     testing::Values(Late::one, Late::three_in_a_row, Late::every_fifth, Late::every_tenth,
                                     Late::of_the_position, Late::of_the_state),
                     testing::Values(210, 260, 300, 400, 500, 700, 900)),
    [](const auto& of) {
      return name(std::get<0>(of.param)) + name(std::get<1>(of.param)) +
             std::to_string(std::get<2>(of.param)) + "MsLate";
    });

}  // namespace
}  // namespace axisgate::test
