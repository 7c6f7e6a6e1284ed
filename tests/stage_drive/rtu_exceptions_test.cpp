// SPDX-License-Identifier: Apache-2.0
// Exceptions of Modbus drives (application protocol V1.1b3, 7): which make an object unsupported until the next
// bring-up, which only put it off, and that both error functions of Kinco's reads are understood.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/stage_drive/rtu_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using testing::IsEmpty;

constexpr std::uint8_t kLastCode = 0x0B;
bool for_ever(int code) { return code <= 2; }

bool supports_position(RtuRig& rig) { return (rig.axis().supported & bit(Quantity::position_actual)) != 0; }

class RtuException : public testing::TestWithParam<std::tuple<Subject, int>> {
 protected:
  Subject kind() const { return std::get<0>(GetParam()); }
  int code() const { return std::get<1>(GetParam()); }
  /// Every read that covers this register is refused with the code while `on`.
  void refuse_reads(RtuRig& rig, std::uint16_t number) const {
    rig.faults().exception_code = static_cast<std::uint8_t>(code());
    rig.on_request = [&rig, number](const RtuRequest& request) {
      if (request.unit == 1 && !request.write && request.covers(number)) rig.faults().next(DriveFault::exception);
    };
  }
  static void end(RtuRig& rig) {
    rig.on_request = [](const RtuRequest&) {};
  }
};

TEST_P(RtuException, OnAReadTakesThatQuantityAwayForEverOrForNow) {
  RtuRig rig(kind(), {.neighbours = false});
  rig.come_up_running();
  refuse_reads(rig, rig.position_register());
  rig.run(5s);
  EXPECT_FALSE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_FALSE(supports_position(rig)) << "what it has now";
  EXPECT_TRUE(rig.online()) << "a drive that refuses is there";
  EXPECT_TRUE(rig.axis()[Quantity::statusword].valid);
  end(rig);
  rig.run(5s);
  EXPECT_EQ(rig.axis()[Quantity::position_actual].valid, !for_ever(code()));
  EXPECT_EQ(supports_position(rig), !for_ever(code()));
  // The next bring-up asks anew.
  rig.stage.rtu_link(0).unplug();
  rig.run(100ms);
  rig.stage.rtu_link(0).plug();
  EXPECT_TRUE(rig.run_until([&] { return rig.online() && rig.axis()[Quantity::position_actual].valid; }, 10s));
  EXPECT_TRUE(supports_position(rig));
  EXPECT_THAT(rig.wrongs(), IsEmpty());
}

TEST_P(RtuException, OnTheStateIsAskedAgainForEver) {
  RtuRig rig(kind(), {.neighbours = false});
  rig.come_up_running();
  refuse_reads(rig, rig.state_register());
  rig.run(5s);
  EXPECT_FALSE(rig.axis()[Quantity::statusword].valid);
  end(rig);
  EXPECT_TRUE(rig.run_until([&] { return rig.online() && rig.axis()[Quantity::statusword].valid; }, 5s));
  EXPECT_THAT(rig.wrongs(), IsEmpty());
}

TEST_P(RtuException, OnAWriteIsTheAnswerWithItsCodeAndNothingIsTakenAsWritten) {
  RtuRig rig(kind(), {.neighbours = false});
  rig.come_up_running();
  const std::int64_t before = rig.axis()[Quantity::profile_velocity].value;
  rig.faults().exception_code = static_cast<std::uint8_t>(code());
  int writes = 0;
  rig.on_request = [&](const RtuRequest& request) {
    if (!request.write) return;
    ++writes;
    rig.faults().next(DriveFault::exception);
  };
  const BatchResult result = rig.stage.write(1, Quantity::profile_velocity, 123'000);
  end(rig);
  EXPECT_EQ(result.outcome.code, Errc::refused_by_drive);
  EXPECT_EQ(result.outcome.detail, static_cast<std::uint32_t>(code()));
  EXPECT_EQ(writes, 1) << "never blindly again";
  rig.run(3s);
  EXPECT_TRUE(rig.online());
  EXPECT_EQ(rig.axis()[Quantity::profile_velocity].value, before);
  EXPECT_TRUE(rig.axis()[Quantity::profile_velocity].valid);
  EXPECT_EQ(rig.stage.write(1, Quantity::profile_velocity, 123'000).outcome.code, Errc::ok);
  EXPECT_THAT(rig.wrongs(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(EachCode, RtuException,
                         testing::Combine(testing::ValuesIn(kOnRtu), testing::Range(1, kLastCode + 1)),
                         [](const auto& of) {
                           return name(std::get<0>(of.param)) + "Code" + std::to_string(std::get<1>(of.param));
                         });

TEST(RtuErrorFunction, OfAKincosReadIsUnderstoodAsPrintedAndAsTheStandardHasIt) {
  for (const Subject kind : {Subject::jd_rtu, Subject::md_rtu}) {
    for (const std::uint8_t function : {std::uint8_t{0x81}, std::uint8_t{0x83}}) {
      RtuRig rig(kind, {.kinco = {.read_error_function = function}, .neighbours = false});
      rig.come_up_running();
      const std::uint32_t timeouts = rig.stage.gateway().bus(0).statistics().timeouts;
      WriteBatch look;
      look.object = ObjectRequest{false, 0x0123, 0, 2, 0};
      const BatchResult result = rig.stage.ask(1, look);
      EXPECT_EQ(result.outcome.code, Errc::refused_by_drive);
      EXPECT_EQ(result.outcome.detail, 2U) << "illegal data address";
      rig.run(2s);
      EXPECT_EQ(rig.stage.gateway().bus(0).statistics().timeouts, timeouts) << "no refusal cost a timeout";
      EXPECT_THAT(rig.wrongs(), IsEmpty());
    }
  }
}

}  // namespace
}  // namespace axisgate::test
