// SPDX-License-Identifier: Apache-2.0
// 3.2 Causes of faults: a fault is shown together with its cause, and told once, on every drive and protocol.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kReset = 5;

/// A fault as the maker's sheet has it.
struct Cause {
  std::uint16_t as_injected;
  std::uint16_t code;
  std::uint32_t vendor;
  std::string text;
};

std::array<Cause, 2> causes_of(Subject subject) {
  if (is_keya(subject))
    return {{{0x0040, 0x2310, 0x0040, "software overcurrent"}, {0x0020, 0x7121, 0x0020, "holding brake"}}};
  if (subject == Subject::id286pro)
    return {{{14, 0x3210, 14, "supply above 90 V"}, {13, 0x3220, 13, "supply below 18 V"}}};
  if (subject == Subject::leadshine)
    return {{{0x3211, 0x3211, 0x0C0, "DC-bus over-voltage"}, {0x4210, 0x4210, 0x0F0, "drive over-temperature"}}};
  return {{{0x0020, 0x3210, 0x0020, "bus voltage too high"}, {0x0200, 0x8611, 0x0200, "following error too large"}}};
}

class Causes : public testing::TestWithParam<Subject> {
 protected:
  void ready() {
    plant_.emplace(GetParam());
    plant_->ready();
  }
  void trip(const Cause& cause) { test::trip(plant_->stage, GetParam(), cause.as_injected); }
  const AxisImage& axis() { return plant_->stage.axis(1); }
  /// Runs until the fault is shown, and looks at every step on the way. Tells what was wrong in one; empty: nothing.
  std::string wrong_until_shown(Duration limit = 3s) {
    std::string wrong;
    const bool shown = plant_->stage.run_until(
        [&] {
          const bool fault = axis().reachable() && axis().has(AxisInput::fault);
          const bool word = axis().reachable() && (axis()[Quantity::statusword].value & 0x08) != 0;
          const auto code = axis()[Quantity::error_code].value, vendor = axis()[Quantity::vendor_error].value;
          if (axis().reachable() && (fault != word || fault != (code != 0) || fault != (vendor != 0)) && wrong.empty())
            wrong = "fault bit " + std::to_string(fault) + ", in the statusword " + std::to_string(word) +
                    ", error_code " + std::to_string(code) + ", vendor_error " + std::to_string(vendor);
          return fault;
        },
        limit);
    return shown ? wrong : "no fault is shown";
  }
  [[nodiscard]] std::uint64_t told_until_now() { return plant_->stage.gateway().events().added(); }
  /// The faults that log and DDS were told of since then.
  std::vector<Event> faults_told(std::uint64_t from) {
    std::vector<Event> out;
    for (const Event& event : plant_->stage.gateway().events().events())
      if (event.number > from && event.axis == 1 && event.kind == EventKind::fault) out.push_back(event);
    return out;
  }
  static std::string texts(const std::vector<Event>& events) {
    std::string out;
    for (const Event& event : events) out += event.text + '\n';
    return out;
  }
  void expect_shown(const Cause& cause, std::uint64_t from) {
    EXPECT_EQ(axis()[Quantity::error_code].value, cause.code);
    EXPECT_EQ(axis()[Quantity::vendor_error].value, cause.vendor);
    plant_->run(1500ms);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), 1U) << texts(told);
    EXPECT_NE(told.front().text.find(cause.text), std::string::npos) << told.front().text;
    EXPECT_EQ(told.front().code, cause.code);
    EXPECT_EQ(axis()[Quantity::error_code].value, cause.code);
  }
  void reset() {
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
    ASSERT_FALSE(axis().has(AxisInput::fault));
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis()[Quantity::error_code].value == 0; }, 3s));
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis()[Quantity::vendor_error].value == 0; }, 3s));
  }
  std::optional<Plant> plant_;
};

TEST_P(Causes, AFaultAndItsCauseAreShownInOneStepAndToldOnce) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    plant_->run(i * 7ms);  // another place in the beat of the polls
    const std::uint64_t from = told_until_now();
    trip(causes.at(static_cast<std::size_t>(i % 2)));
    EXPECT_EQ(wrong_until_shown(), "");
    expect_shown(causes.at(static_cast<std::size_t>(i % 2)), from);
    reset();
  }
}

// 3.2 Causes of faults: "never with the cause of the fault before", how soon ever the next one comes.
TEST_P(Causes, TheNextFaultHasItsOwnCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    trip(causes[0]);
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
    plant_->run(i * 3ms);
    const std::uint64_t from = told_until_now();
    trip(causes[1]);
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
    expect_shown(causes[1], from);
    reset();
  }
}

TEST_P(Causes, AFaultOfTheTimeWithoutALinkIsShownWithItsCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (const Duration away : {100ms, 4000ms}) {
    plant_->unplug();
    plant_->run(away);
    trip(causes[1]);
    plant_->run(20ms);
    const std::uint64_t from = told_until_now();
    plant_->plug();
    if (is_keya(GetParam()) || (away > 1s && minds_silence(GetParam()))) {
      // The drive's own watchdog has its say as well.
      ASSERT_TRUE(plant_->stage.run_until([this] { return axis().reachable() && axis().has(AxisInput::fault); }));
      plant_->run(1500ms);
      ASSERT_EQ(faults_told(from).size(), 1U) << texts(faults_told(from));
      EXPECT_NE(axis()[Quantity::error_code].value, 0);
    } else {
      EXPECT_EQ(wrong_until_shown(20s), "");
      expect_shown(causes[1], from);
    }
    if (away < 1s) reset();
  }
}

TEST_P(Causes, AFaultThatIsThereAtTheStartIsShownWithItsCause) {
  ready();
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    plant_->crash_gateway();
    plant_->run(i % 2 == 0 ? 300ms : 1ms);
    if (i < 2) trip(causes[0]);
    plant_->start_gateway();
    plant_->a.connect();
    plant_->run(i * 2ms);
    if (i >= 2) trip(causes[0]);
    EXPECT_EQ(wrong_until_shown(20s), "");
    expect_shown(causes[0], 0);
    reset();
  }
}

// A lost answer delays both together, and what is known late is told all the same.
TEST_P(Causes, ALostAnswerPartsNoFaultFromItsCause) {
  const auto causes = causes_of(GetParam());
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    ready();
    plant_->run(i * 11ms);
    const std::uint64_t from = told_until_now();
    trip(causes[0]);
    plant_->run(i % 4 * 2ms);
    ASSERT_TRUE(plant_->strike(i % 2 == 0 ? Strike::lose_reply : Strike::lose_request));
    EXPECT_EQ(wrong_until_shown(), "");
    plant_->run(1500ms);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), 1U) << texts(told);
    EXPECT_NE(told.front().text.find(causes[0].text), std::string::npos) << told.front().text;
    EXPECT_EQ(axis()[Quantity::error_code].value, causes[0].code);
  }
}

constexpr std::uint16_t kGeneric = 0x1000;

class CausesUnnamed : public Causes {};

// "0x1000 only if the drive has named no cause within 500 ms".
TEST_P(CausesUnnamed, ADriveThatRefusesItsFaultWordsIsShownFaultedAfterHalfASecond) {
  plant_.emplace(GetParam());
  lack(plant_->stage, GetParam(), {{0x2601}, {0x2602}, {0x603F}});
  const bool on_can =
      GetParam() == Subject::leadshine || GetParam() == Subject::jd_can || GetParam() == Subject::md_can;
  if (on_can) plant_->stage.can_node(0).facts().sends_emergencies = false;
  plant_->ready();
  const std::uint64_t from = told_until_now();
  const Instant tripped = plant_->stage.runtime().now();
  trip(causes_of(GetParam())[0]);
  ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
  EXPECT_GE(plant_->stage.runtime().now() - tripped, 500ms);
  EXPECT_LE(plant_->stage.runtime().now() - tripped, 1000ms);
  EXPECT_EQ(axis()[Quantity::error_code].value, kGeneric);
  EXPECT_TRUE(axis()[Quantity::error_code].valid);
  plant_->run(2s);
  ASSERT_EQ(faults_told(from).size(), 1U) << texts(faults_told(from));
  EXPECT_NE(faults_told(from).front().text.find("names no cause"), std::string::npos);
  EXPECT_EQ(plant_->motor().enabled, false);
}

class CausesOnCan : public Causes {};

TEST_P(CausesOnCan, ALostEmergencyIsNotMissed) {
  ready();
  plant_->stage.can_node(0).facts().sends_emergencies = false;
  const auto causes = causes_of(GetParam());
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint64_t from = told_until_now();
    trip(causes.at(i % 2));
    EXPECT_EQ(wrong_until_shown(), "");
    expect_shown(causes.at(i % 2), from);
    reset();
  }
}

// What it sends is all that it tells, and of the fault before it tells nothing.
TEST_P(CausesOnCan, AnEmergencyNamesTheFaultOfADriveThatRefusesItsWords) {
  plant_.emplace(GetParam());
  lack(plant_->stage, GetParam(), {{0x2601}, {0x2602}, {0x603F}});
  plant_->ready();
  const auto causes = causes_of(GetParam());
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    if (i == 2) plant_->stage.can_node(0).facts().sends_emergencies = false;
    const std::uint64_t from = told_until_now();
    trip(causes.at(i % 2));
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
    EXPECT_EQ(axis()[Quantity::error_code].value, i == 2 ? kGeneric : causes.at(i).code);
    plant_->run(1s);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), 1U) << texts(told);
    EXPECT_NE(told.front().text.find(i == 2 ? std::string("names no cause") : causes.at(i).text), std::string::npos)
        << told.front().text;
    EXPECT_EQ(told.front().code, axis()[Quantity::error_code].value);
    if (i == 1) plant_->stage.can_node(0).facts().sends_emergencies = false;  // nor does it say that the error is over
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
    EXPECT_EQ(axis()[Quantity::error_code].value, 0);
  }
}

TEST_P(CausesOnCan, AnEmergencyThatComesLateChangesNothing) {
  ready();
  plant_->stage.can_node(0).facts().sends_emergencies = false;
  const auto causes = causes_of(GetParam());
  const auto emergency = [&](std::uint16_t code) {
    auto& link = plant_->stage.can_link(0);
    link.line().send_emergency(0, code, link.time_of(plant_->stage.runtime().now()));
  };
  for (const std::size_t late : {0U, 1U}) {
    const std::uint64_t from = told_until_now();
    if (late == 0) emergency(causes[1].code);  // what it had still to say of another fault
    trip(causes[0]);
    if (late == 1) {
      ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
      emergency(causes[1].code);
    }
    EXPECT_EQ(wrong_until_shown(), "");
    expect_shown(causes[0], from);
    reset();
  }
}

class CausesOfTheMd : public Causes {};

// The first word says "see the second": the gateway has it.
TEST_P(CausesOfTheMd, TheSecondFaultWordSpeaks) {
  ready();
  const bool readable = GetParam() != Subject::md_rtu;  // it has no Modbus address (MD 3)
  constexpr std::uint16_t kWatchdog = 0x0002, kNotPrinted = 0x1000;
  for (const std::uint16_t bits : {kWatchdog, kNotPrinted}) {
    const std::uint64_t from = told_until_now();
    plant_->stage.drive(0).inject_fault(2, bits);
    plant_->stage.drive(0).clear_fault_cause(2, bits);
    ASSERT_TRUE(plant_->stage.run_until([this] { return axis().has(AxisInput::fault); }, 3s));
    plant_->run(1s);
    ASSERT_EQ(faults_told(from).size(), 1U) << texts(faults_told(from));
    const std::string told = faults_told(from).front().text;
    EXPECT_EQ(told.find("software watchdog") != std::string::npos, readable && bits == kWatchdog) << told;
    EXPECT_EQ(told.find(bits == kWatchdog ? "0x0002" : "0x1000") != std::string::npos, readable) << told;
    EXPECT_EQ(told.find("read 2602"), std::string::npos) << told;
    reset();
  }
}

INSTANTIATE_TEST_SUITE_P(Every, CausesUnnamed, testing::ValuesIn(subjects([](Subject s) { return is_cia402(s); })),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, CausesOnCan, testing::Values(Subject::jd_can, Subject::md_can, Subject::leadshine),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, CausesOfTheMd, testing::Values(Subject::md_serial, Subject::md_rtu, Subject::md_can),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, Causes, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
