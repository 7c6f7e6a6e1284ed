// SPDX-License-Identifier: Apache-2.0
// Which commands are carried out though they came: for this gateway, not too old, and of a name that nobody else has.
#include <gmock/gmock.h>

#include "gateway/upstream/dds/addressee.hpp"
#include "gateway/upstream/dds/dds_clients.hpp"
#include "gateway/upstream/dds/signs_of_life.hpp"
#include "gateway/upstream/dds_link/command_mask.hpp"
#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::command;
using test::guid;
using test::kStart;
using test::PlainSession;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kTold = 2, kTooOld = 6, kWrong = 17, kTaken = 22;
constexpr std::uint8_t kEnable = 1, kDisable = 2, kQuickStop = 3, kHalt = 4, kFaultReset = 5, kMove = 6, kRun = 8,
                       kRelease = 13, kJogForward = 31, kJogEnd = 33;

DdsSettings named(const std::string& name, std::optional<Duration> max_age = {}) {
  DdsSettings out = PlainSession::settings();
  out.gateway = gateway_id(name);
  out.max_age = max_age;
  return out;
}

struct Named : testing::Test {
  PlainSession plain{1, named("cell_7")};
  std::uint64_t id = 0;
  Named() { plain.port.at_once = BatchResult{}; }
  int ask(const GatewayId& gateway, std::uint8_t number) {
    plain.port.submitted.clear();
    CommandRecord record = command(guid(1), number, ++id);
    record.gateway = gateway;
    return plain.ask(record);
  }
};

TEST(GatewayKey, IsTheCrc32OfTheName) {
  EXPECT_EQ(gateway_key("cell_7"), 0xDBD3BA01U);
  EXPECT_EQ(gateway_key(""), 0U);
  EXPECT_TRUE(is_gateway_name("cell_7"));
  for (const char* wrong : {"", "7cell", "_cell", "Cell", "cell-7", "a.b", "abcdefghijklmnopqrstuvwxyzabcdefg"})
    EXPECT_FALSE(is_gateway_name(wrong)) << wrong;
}

TEST_F(Named, TakeWhatIsForExactlyThem) { EXPECT_EQ(ask(gateway_id("cell_7"), kEnable), kTold); }

TEST_F(Named, LeaveOthersCommandsToThemWithoutAWord) {
  for (const std::uint8_t number : {kEnable, kMove, kQuickStop, kDisable, kJogEnd, kRelease}) {
    EXPECT_EQ(ask(gateway_id("cell_8"), number), 0) << int{number};
    EXPECT_THAT(plain.port.submitted, IsEmpty()) << int{number};
  }
  EXPECT_THAT(plain.told, IsEmpty());
}

TEST_F(Named, RefuseWhatIsMeantForThemByHalf) {
  for (const GatewayId& half : {GatewayId{gateway_key("cell_7"), ""}, GatewayId{1, "cell_7"}}) {
    EXPECT_EQ(ask(half, kEnable), kWrong);
    EXPECT_THAT(plain.port.submitted, IsEmpty());
    EXPECT_EQ(ask(half, kHalt), kTold) << "a stop is never refused for a name";
    EXPECT_THAT(plain.port.submitted, SizeIs(1));
  }
}

TEST_F(Named, TakeNoCommandWithoutANameButEveryStop) {
  for (const GatewayId& nobody : {GatewayId{}, GatewayId{77, "cell_9"}}) {
    EXPECT_EQ(ask(nobody, kEnable), 0);
    EXPECT_THAT(plain.port.submitted, IsEmpty());
    for (const std::uint8_t number : {kQuickStop, kDisable, kHalt, kJogEnd, kRelease}) {
      EXPECT_EQ(ask(nobody, number), kTold) << int{number};
      EXPECT_THAT(plain.port.submitted, SizeIs(1)) << int{number};
    }
  }
  EXPECT_THAT(plain.told, Each(HasSubstr("this one is \"cell_7\", key dbd3ba01")));
  EXPECT_THAT(plain.told, SizeIs(2));
}

TEST_F(Named, LeaveObjectsOfOthersAlone) {
  plain.port.submitted.clear();
  ObjectRequestRecord object{guid(1, 2), 0, gateway_id("cell_8"), 1, 3, false, 0x1000, 0, 4, 0, {}};
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), 0);
  object.gateway = {gateway_key("cell_7"), "cell_8x"};
  object.request_id = 4;
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kWrong);
  EXPECT_THAT(plain.port.submitted, IsEmpty());
}

TEST(Names, OfOneKeyAreToldApart) {
  // Two names with one CRC-32 would be this: the key is ours, and the name's own.
  const GatewayId own{gateway_key("cell_8"), "cell_7"};
  EXPECT_EQ(addressee(gateway_id("cell_8"), own), Addressee::other);
}

struct Aged : testing::Test {
  PlainSession plain{1, named("", 500ms)};
  std::uint64_t id = 0;
  Aged() { plain.port.at_once = BatchResult{}; }
  CommandRecord written(std::uint8_t number, Duration ago) {
    CommandRecord out = command(guid(1), number, ++id);
    out.written = (plain.now - ago).time_since_epoch().count();
    return out;
  }
  int ask(const CommandRecord& record) {
    plain.port.submitted.clear();
    return plain.ask(record);
  }
};

TEST_F(Aged, CommandsAreNotCarriedOutBeyondTheirTimeNorBeforeIt) {
  for (const Duration ago : {500ms, 0ms, -500ms}) EXPECT_EQ(ask(written(kEnable, ago)), kTold);
  for (const Duration ago : {501ms, 6500ms, -501ms}) {
    EXPECT_EQ(ask(written(kEnable, ago)), kTooOld);
    EXPECT_THAT(plain.port.submitted, IsEmpty());
  }
  CommandRecord timeless = written(kEnable, 0ms);
  timeless.written = 0;
  EXPECT_EQ(ask(timeless), kTooOld) << "nobody can tell its age";
}

TEST_F(Aged, OnesMayBeAskedAgain) {
  CommandRecord record = written(kEnable, 1s);
  EXPECT_EQ(ask(record), kTooOld);
  record.written = plain.now.time_since_epoch().count();
  EXPECT_EQ(ask(record), kTold);
}

TEST_F(Aged, StopsAndReleasesAreCarriedOutAloneAndRenewNothing) {
  for (const std::uint8_t number : {kDisable, kQuickStop, kHalt, kJogEnd, kRelease}) {
    EXPECT_EQ(ask(written(number, 10s)), kTold) << int{number};
    ASSERT_THAT(plain.port.submitted, SizeIs(1)) << int{number};
    EXPECT_FALSE(plain.port.submitted.front().batch.renews) << int{number};
    CommandRecord beside = written(number, 10s);
    beside.mask = kHasTargetVelocity;
    beside.target_velocity = 1;
    EXPECT_EQ(ask(beside), kTooOld) << "said of what stands beside it";
    ASSERT_THAT(plain.port.submitted, SizeIs(1)) << int{number};
    EXPECT_THAT(plain.port.submitted.front().batch.setpoints, IsEmpty()) << int{number};
  }
}

TEST_F(Aged, ObjectsAreNotAskedForEither) {
  ObjectRequestRecord object{guid(1, 2), 1, {}, 1, 3, true, 0x1000, 0, 4, 0, {}};
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kTooOld);
}

struct TwoOfOneName : testing::Test {
  PlainSession plain{2, named("cell_7")};
  std::uint64_t id = 0;
  TwoOfOneName() { plain.port.at_once = BatchResult{}; }
  int ask(std::uint8_t number, std::uint32_t mask = 0) {
    CommandRecord record = command(guid(1), number, ++id);
    record.gateway = gateway_id("cell_7");
    record.mask = mask;
    record.jog_velocity = record.target_velocity = 1;
    return plain.ask(record);
  }
  void duplicate(std::uint16_t axis, bool gone = false) {
    plain.session->on_record(NamesakeRecord{guid(9), axis, "192.168.1.8", gone}, plain.now);
  }
};

TEST_F(TwoOfOneName, StartNothingUntilOneIsGone) {
  EXPECT_EQ(ask(kJogForward, kHasJogVelocity), kTold);
  duplicate(2);
  EXPECT_THAT(plain.name_taken, ElementsAre(true));
  for (const std::uint8_t number : {kEnable, kMove, kRun}) EXPECT_EQ(ask(number), kTaken) << int{number};
  EXPECT_NE(ask(kJogForward, kHasJogVelocity), kTaken) << "the button that is held goes on";
  EXPECT_EQ(ask(kJogEnd), kTold);
  EXPECT_EQ(ask(kJogForward, kHasJogVelocity), kTaken) << "a new press";
  EXPECT_EQ(ask(kQuickStop), kTold);
  duplicate(0, true);
  EXPECT_THAT(plain.name_taken, ElementsAre(true, false));
  EXPECT_EQ(ask(kEnable), kTold);
}

// A drive in a velocity mode runs by its set-point alone.
TEST_F(TwoOfOneName, StartNothingBySetpointsEither) {
  duplicate(1);
  AxisImage& axis = *plain.image.find(1);
  axis.axis_state = AxisState::standstill;
  EXPECT_EQ(ask(0, kHasMode), kTaken);
  for (const std::uint32_t target : {kHasTargetPosition, kHasTargetVelocity, kHasTargetTorque}) {
    EXPECT_EQ(ask(0, target), kTaken) << target;
    EXPECT_EQ(ask(kFaultReset, target), kTaken) << target;
  }
  EXPECT_EQ(ask(0, kHasProfileVelocity), kTold);
  EXPECT_EQ(ask(kFaultReset), kTold);
  axis.axis_state = AxisState::discrete_motion;
  EXPECT_EQ(ask(0, kHasTargetPosition), kTold);
  EXPECT_EQ(ask(0, kHasTargetVelocity), kTaken) << "it is not what runs";
  axis.axis_state = AxisState::continuous_motion;
  EXPECT_EQ(ask(0, kHasTargetVelocity), kTold) << "a run that is on";
  EXPECT_EQ(ask(0, kHasTargetTorque), kTold);
  EXPECT_EQ(ask(0, kHasTargetPosition), kTaken);
  axis[Quantity::mode_display].value = 3;
  EXPECT_EQ(ask(0, kHasMode | kHasTargetVelocity), kTaken) << "another mode";
  axis[Quantity::mode_display].value = 0;
  EXPECT_EQ(ask(0, kHasMode | kHasTargetVelocity), kTold);
}

TEST_F(TwoOfOneName, StopAndLetGoAndNoMoreThanThat) {
  duplicate(1);
  plain.image.find(1)->axis_state = AxisState::standstill;
  for (const std::uint8_t number : {kQuickStop, kHalt, kRelease}) {
    plain.port.submitted.clear();
    EXPECT_EQ(ask(number, kHasMode | kHasTargetVelocity), kTaken) << "said of what stands beside it";
    ASSERT_THAT(plain.port.submitted, SizeIs(1)) << int{number};
    EXPECT_THAT(plain.port.submitted.front().batch.setpoints, IsEmpty()) << int{number};
    EXPECT_FALSE(plain.port.submitted.front().batch.mode) << int{number};
  }
}

TEST_F(TwoOfOneName, WriteNoObjects) {
  ObjectRequestRecord object{guid(1, 2), 1, gateway_id("cell_7"), 1, 1, false, 0x6040, 0, 2, 15, {}};
  duplicate(1);
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kTold) << "a read";
  object.request_id = 2;
  object.write = true;
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kTaken);
}

TEST_F(TwoOfOneName, WithOtherAxesAreNone) {
  duplicate(3);
  EXPECT_THAT(plain.name_taken, IsEmpty());
  EXPECT_EQ(ask(kEnable), kTold);
}

TEST_F(TwoOfOneName, WhoseAxisBecomesOursByAReloadAreTakenFromThenOn) {
  duplicate(3);
  test::add_axis(plain.image, 3);
  plain.session->take_axes({}, plain.now);
  EXPECT_THAT(plain.name_taken, ElementsAre(true));
  EXPECT_EQ(ask(kEnable), kTaken);
  plain.image.remove_axis(3);
  plain.session->take_axes({}, plain.now);
  EXPECT_THAT(plain.name_taken, ElementsAre(true, false));
  EXPECT_EQ(ask(kEnable), kTold);
}

TEST_F(TwoOfOneName, OfWhichOneGivesUpTheAxisAreNoneAnyMore) {
  duplicate(1);
  duplicate(2);
  duplicate(1, true);
  EXPECT_EQ(ask(kEnable), kTaken) << "there is another one";
  duplicate(2, true);
  EXPECT_THAT(plain.name_taken, ElementsAre(true, false));
  EXPECT_EQ(ask(kEnable), kTold);
}

TEST_F(TwoOfOneName, AreWaitedForAfterANewStartOfTheProcess) {
  duplicate(1);
  plain.session->on_link_down(plain.now);
  plain.session->on_link_up(plain.now);
  EXPECT_EQ(ask(kEnable), kTaken) << "it has not been looked for yet";
  plain.now += kReturnsWithin;
  static_cast<void>(plain.read());
  EXPECT_EQ(ask(kEnable), kTold);
  EXPECT_THAT(plain.name_taken, ElementsAre(true, false));
}

TEST(Start, OfManyAxesLosesNoEvent) {
  PlainSession plain(200);
  for (int i = 0; i < 600; ++i)
    plain.ring.add(plain.now, static_cast<AxisNumber>(1 + i % 200), EventKind::link, 0, "online");
  EXPECT_THAT(plain.read<EventRecord>(), SizeIs(600));
}

}  // namespace
}  // namespace axisgate::dds
