// SPDX-License-Identifier: Apache-2.0
// Faults of drives whose fault words tell nothing, or too late, and what an EMCY says of them.
#include "tests/obey/causes.hpp"

#include <gtest/gtest.h>

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kGeneric = 0x1000;

class CausesUnnamed : public Causes {
 protected:
  /// Of a drive that refuses its fault words and sends no EMCY.
  void trip_unnamed() {
    plant_.emplace(GetParam());
    lack(plant_->stage, GetParam(), {{0x2601}, {0x2602}, {0x603F}});
    const bool on_can =
        GetParam() == Subject::leadshine || GetParam() == Subject::jd_can || GetParam() == Subject::md_can;
    if (on_can) plant_->stage.can_node(0).facts().sends_emergencies = false;
    plant_->ready();
    told_ = told_until_now();
    trip(causes_of(GetParam())[0]);
    ASSERT_TRUE(until_faulted());
    shown_at_ = now();
    ASSERT_EQ(shown(Quantity::error_code), kUnknownCode);
  }
  std::uint64_t told_ = 0;
  Instant shown_at_ = kLongAgo;
};

// "error_code is valid after 500 ms at the latest (0x1000 where nothing was named)".
TEST_P(CausesUnnamed, ADriveThatRefusesItsFaultWordsHasTheGenericCauseAfterHalfASecond) {
  trip_unnamed();
  EXPECT_EQ(plant_->motor().enabled, false);
  EXPECT_EQ(wrong_until_known(), "");
  EXPECT_GE(now() - shown_at_, 500ms);
  EXPECT_LE(now() - shown_at_, 501ms);
  EXPECT_EQ(shown(Quantity::error_code), kGeneric);
  plant_->run(2s);
  ASSERT_EQ(faults_told(told_).size(), 1U) << texts(faults_told(told_));
  EXPECT_NE(faults_told(told_).front().text.find("names no cause"), std::string::npos);
  EXPECT_EQ(faults_told(told_).front().code, kGeneric);
}

// "No reply is held back for it."
TEST_P(CausesUnnamed, WhatIsAskedMeanwhileIsAnsweredMeanwhile) {
  trip_unnamed();
  EXPECT_TRUE(plant_->a.row(row::profile_velocity, 123'000).ok());
  EXPECT_EQ(plant_->a.command(1), kFailed);
  EXPECT_LT(now() - shown_at_, 500ms);
  EXPECT_EQ(shown(Quantity::error_code), kUnknownCode);
  EXPECT_TRUE(faults_told(told_).empty()) << texts(faults_told(told_));
}

TEST_P(CausesUnnamed, AFaultThatIsResetBeforeItsCauseWasReadIsToldOnceAsOver) {
  trip_unnamed();
  ASSERT_EQ(plant_->a.command(0), kOk);
  ASSERT_EQ(plant_->a.command(kReset), kOk);
  ASSERT_LT(now() - shown_at_, 500ms);
  EXPECT_EQ(shown(Quantity::error_code), 0);
  plant_->run(2s);
  EXPECT_EQ(shown(Quantity::error_code), 0);
  ASSERT_EQ(faults_told(told_).size(), 1U) << texts(faults_told(told_));
  EXPECT_NE(faults_told(told_).front().text.find("a fault whose cause was not read is over after 0."),
            std::string::npos)
      << faults_told(told_).front().text;
}

class CausesOnCan : public Causes {
 protected:
  void emergency(std::uint16_t code) {
    auto& link = plant_->stage.can_link(0);
    link.line().send_emergency(0, code, link.time_of(now()));
  }
};

TEST_P(CausesOnCan, ALostEmergencyIsNotMissed) {
  ready();
  plant_->stage.can_node(0).facts().sends_emergencies = false;
  const auto causes = causes_of(GetParam());
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint64_t from = told_until_now();
    trip(causes.at(i % 2));
    EXPECT_EQ(wrong_until_known(), "");
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
    ASSERT_TRUE(until_faulted());
    EXPECT_EQ(shown(Quantity::error_code), i == 2 ? kUnknownCode : causes.at(i).code) << "at once";
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

// Its words say more than what it has sent.
TEST_P(CausesOnCan, AnEmergencyOfAnotherFaultGivesWayToWhatTheWordsSay) {
  ready();
  plant_->stage.can_node(0).facts().sends_emergencies = false;
  const auto causes = causes_of(GetParam());
  for (const bool before : {true, false}) {
    const std::uint64_t from = told_until_now();
    if (before) emergency(causes[1].code);  // what it had still to say of another fault
    trip(causes[0]);
    if (!before) {
      ASSERT_TRUE(until_faulted());
      emergency(causes[1].code);
    }
    EXPECT_EQ(wrong_until_known(), "");
    plant_->run(100ms);
    expect_shown(causes[0], from);
    reset();
  }
}

TEST_P(CausesOnCan, AnEmergencyNamesTheCauseAtOnceAndALateOneGetsALineOfItsOwn) {
  plant_.emplace(GetParam());
  lack(plant_->stage, GetParam(), {{0x2601}, {0x2602}, {0x603F}});
  plant_->stage.can_node(0).facts().sends_emergencies = false;
  plant_->ready();
  const auto causes = causes_of(GetParam());
  for (const Duration after : {0ms, 300ms, 800ms}) {
    const std::uint64_t from = told_until_now();
    trip(causes[0]);
    ASSERT_TRUE(until_faulted());
    plant_->run(after);
    EXPECT_EQ(shown(Quantity::error_code), after > 500ms ? kGeneric : kUnknownCode);
    const std::uint32_t sequence = axis().sequence;
    emergency(causes[0].code);
    plant_->run(5ms);
    EXPECT_EQ(shown(Quantity::error_code), causes[0].code);
    EXPECT_TRUE(cause_is_known());
    EXPECT_NE(axis().sequence, sequence);
    plant_->run(2s);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), after > 500ms ? 2U : 1U) << texts(told);
    EXPECT_NE(told.back().text.find(causes[0].text), std::string::npos) << told.back().text;
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
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
    ASSERT_TRUE(until_faulted());
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

}  // namespace
}  // namespace axisgate::test::obey
