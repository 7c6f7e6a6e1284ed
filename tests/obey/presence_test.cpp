// SPDX-License-Identifier: Apache-2.0
// Who is there and who is not: a drive that was never there, and a device that is not what its profile says.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kNoPath = 0x0A;
constexpr std::uint16_t kLinkStateRow = 18, kAlarmsRow = 34;
constexpr unsigned kBitOfMismatch = 12;

class Presence : public testing::TestWithParam<Subject> {};

// It read "unknown" for 73 s on CANopen.
TEST_P(Presence, ADriveThatWasNeverThereIsOfflineAfterThreeTimeouts) {
  Plant plant(GetParam());
  plant.crash_gateway();
  plant.cut_wire();
  plant.start_gateway();
  plant.a.connect();
  ASSERT_TRUE(plant.stage.run_until([&] { return plant.stage.axis(1).link_state == LinkState::offline; }, 5s));
  EXPECT_EQ(plant.a.command(kEnable), kNoPath);
  plant.run(60s);
  EXPECT_EQ(plant.stage.axis(1).link_state, LinkState::offline);
  // And it is found when it comes.
  plant.mend_wire();
  EXPECT_TRUE(plant.stage.run_until([&] { return plant.stage.axis(1).link_state == LinkState::online; }, 150s));
}

INSTANTIATE_TEST_SUITE_P(Every, Presence, testing::ValuesIn(kSubjects), named);

/// What a profile cannot do without, on drives that refuse what they do not have.
struct Lacking {
  Subject subject;
  ObjectPlace status;
  ObjectPlace position;
  ObjectPlace there;  ///< what it still has, for the mailbox
  std::uint16_t size = 2;
};
void PrintTo(const Lacking& lacking, std::ostream* out) { *out << name(lacking.subject); }

bool on_can(Subject s) {
  return s == Subject::jd_can || s == Subject::md_can || s == Subject::leadshine || s == Subject::keya_canopen_speed ||
         s == Subject::keya_canopen_position;
}
bool stage_is_serial(Subject s) { return s == Subject::jd_serial || s == Subject::md_serial; }

simulated::TenByteFrame serial_frame(const std::vector<Byte>& bytes) {
  simulated::TenByteFrame frame{};
  std::copy_n(bytes.begin(), frame.size(), frame.begin());
  return frame;
}

class Mismatch : public testing::TestWithParam<Lacking> {
 protected:
  [[nodiscard]] bool alarmed() {
    return (static_cast<std::uint32_t>(plant_->a.wide(kAlarmsRow)) >> kBitOfMismatch & 1U) != 0;
  }
  [[nodiscard]] std::size_t told() {
    std::size_t count = 0;
    for (const Event& event : plant_->stage.gateway().events().events())
      count += event.axis == 1 && event.text.find("profile_mismatch") != std::string::npos;
    return count;
  }
  Answer answer_of(RequestNumber request) {
    std::optional<Answer> answer;
    plant_->stage.run_until([&] { return (answer = plant_->a.answer_of(request)).has_value(); }, 10s);
    if (!answer) throw std::runtime_error("43/13 was not answered");
    return *answer;
  }
  /// The mailbox reads, and so does 43/13; neither writes anything.
  void expect_readable_alone() {
    const ObjectPlace& there = GetParam().there;
    EXPECT_EQ(answer_of(plant_->a.ask_for_object(there.index, there.sub)), kOk);
    note_begin();
    Write reference{.function = fc::general_reference, .first = 80};
    reference.words = {2, there.index, there.sub, GetParam().size, 0, 15};
    EXPECT_EQ(plant_->a.write(reference), kNotNow) << "an enable by 43/13, where it is a controlword";
    EXPECT_EQ(changes_sent(), 0U);
    ASSERT_EQ(plant_->a.rows(81, 83, {{81, there.index}, {82, there.sub}, {83, GetParam().size}}), kOk);
    EXPECT_EQ(plant_->a.row(80, 1), kOk);
    plant_->run(1s);
    EXPECT_EQ(plant_->a.word(86), 2) << "done";
    EXPECT_FALSE(plant_->a.mailbox_write(there.index, there.sub, GetParam().size, 15))
        << "an enable, where it is a controlword";
  }
  void expect_nothing_moves() {
    for (const std::int64_t command : {kEnable, kMove, kRun, kRelative})
      EXPECT_EQ(plant_->a.command(command).ok(), false) << command;
    EXPECT_FALSE(plant_->a.coil(coil::enable, true).ok());
    EXPECT_FALSE(plant_->a.row(row::controlword, 15).ok());
    EXPECT_EQ(plant_->velocity(), 0);
  }
  /// Requests of the gateway, since its process began, that change what the device holds or does.
  [[nodiscard]] std::size_t changes_sent() {
    GatewayStage& stage = plant_->stage;
    std::size_t count = 0;
    if (on_can(GetParam().subject)) {
      // CiA 301 7.2.4.3: ccs 1 begins a download; 7.2.8.3: NMT has the identifier 0.
      for (std::size_t i = begun_; i < stage.can_link(0).sent.size(); ++i) {
        const auto& frame = stage.can_link(0).sent[i].frame;
        count += frame.id == 0 || (frame.id > 0x600 && frame.id < 0x680 && frame.data[0] >> 5 == 1);
      }
    } else if (stage_is_serial(GetParam().subject)) {
      for (std::size_t i = begun_; i < stage.link(0).sent.size(); ++i)
        count += simulated::command_of(serial_frame(stage.link(0).sent[i].bytes)) != simulated::FrameCommand::read;
    } else {
      for (std::size_t i = begun_; i < stage.rtu_link(0).sent.size(); ++i)
        count += stage.rtu_link(0).sent[i].bytes.at(1) != 3;
    }
    return count;
  }
  void note_begin() {
    GatewayStage& stage = plant_->stage;
    begun_ = on_can(GetParam().subject)            ? stage.can_link(0).sent.size()
             : stage_is_serial(GetParam().subject) ? stage.link(0).sent.size()
                                                   : stage.rtu_link(0).sent.size();
  }
  std::optional<Plant> plant_;
  std::size_t begun_ = 0;
};

// What it is nobody knows: its setup list could make it move, or make it another device for good.
TEST_P(Mismatch, ADeviceThatIsNotWhatItsProfileSaysIsWrittenNothing) {
  for (const ObjectPlace& lacking : {GetParam().status, GetParam().position}) {
    plant_.emplace(GetParam().subject);
    ASSERT_TRUE(plant_->stage.come_online());
    plant_->crash_gateway();
    plant_->restart_drive(100ms);
    plant_->run(5s);
    ASSERT_TRUE(lack(plant_->stage, GetParam().subject, {lacking}));
    note_begin();
    plant_->start_gateway();
    plant_->a.connect();
    plant_->run(20s);
    EXPECT_TRUE(alarmed());
    EXPECT_EQ(changes_sent(), 0U) << std::hex << lacking.index;
  }
}

TEST_P(Mismatch, ADeviceWithoutAStatuswordIsToldOnceAndReadButNotMoved) {
  plant_.emplace(GetParam().subject);
  ASSERT_TRUE(plant_->stage.come_online());
  plant_->crash_gateway();
  ASSERT_TRUE(lack(plant_->stage, GetParam().subject, {GetParam().status}));
  plant_->start_gateway();
  plant_->a.connect();
  plant_->run(20s);
  EXPECT_EQ(plant_->a.word(kLinkStateRow), 1) << "setup";
  EXPECT_TRUE(alarmed());
  EXPECT_EQ(told(), 1U);
  expect_nothing_moves();
  expect_readable_alone();
  // The right one is put in.
  lack(plant_->stage, GetParam().subject, {});
  ASSERT_TRUE(plant_->stage.come_online());
  EXPECT_FALSE(alarmed());
  plant_->ready();
  EXPECT_NE(plant_->motor().enabled, false);
}

TEST_P(Mismatch, ADeviceWithoutAPositionIsToldOnceAndReadButNotMoved) {
  plant_.emplace(GetParam().subject);
  ASSERT_TRUE(plant_->stage.come_online());
  plant_->crash_gateway();
  ASSERT_TRUE(lack(plant_->stage, GetParam().subject, {GetParam().position}));
  plant_->start_gateway();
  plant_->a.connect();
  ASSERT_TRUE(plant_->stage.come_online());
  plant_->run(20s);
  EXPECT_TRUE(alarmed());
  EXPECT_EQ(told(), 1U);
  expect_nothing_moves();
  expect_readable_alone();
  plant_->cut_wire();
  ASSERT_TRUE(plant_->stage.run_until([&] { return plant_->stage.axis(1).link_state == LinkState::offline; }));
  lack(plant_->stage, GetParam().subject, {});
  plant_->mend_wire();
  ASSERT_TRUE(plant_->stage.run_until([&] { return plant_->stage.axis(1).link_state == LinkState::online; }, 150s));
  EXPECT_FALSE(alarmed());
  plant_->ready();
  EXPECT_NE(plant_->motor().enabled, false);
}

INSTANTIATE_TEST_SUITE_P(Every, Mismatch,
                         testing::Values(Lacking{Subject::jd_serial, {0x6041}, {0x6063}, {0x6040}},
                                         Lacking{Subject::md_serial, {0x6041}, {0x6063}, {0x6040}},
                                         Lacking{Subject::jd_rtu, {0x6041}, {0x6063}, {0x3100}},
                                         Lacking{Subject::md_rtu, {0x6041}, {0x6063}, {0x3100}},
                                         Lacking{Subject::jd_can, {0x6041}, {0x6063}, {0x6040}},
                                         Lacking{Subject::md_can, {0x6041}, {0x6063}, {0x6040}},
                                         Lacking{Subject::leadshine, {0x6041}, {0x6064}, {0x6040}},
                                         Lacking{Subject::keya_canopen_speed, {0x2011}, {0x2016}, {0x2012}},
                                         Lacking{Subject::keya_canopen_position, {0x2011}, {0x2016}, {0x2012}},
                                         Lacking{Subject::id286pro, {108}, {117}, {101}},
                                         Lacking{Subject::id286pro, {109}, {117}, {101}}),
                         [](const auto& tested) { return name(tested.param.subject) + std::to_string(tested.index); });

}  // namespace
}  // namespace axisgate::test::obey
