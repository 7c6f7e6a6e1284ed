// SPDX-License-Identifier: Apache-2.0
// Profiles on Modbus RTU: what each Kinco gives there, its line, and the reads that stand as resynchronisation reads.
#include <gmock/gmock.h>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using testing::Pair;

model::DriveModel on_rtu(const std::string& drive) {
  ResolveInput input = kinco_axis();
  input.protocol = "modbus-rtu";
  input.constants["rated_current_a"] = Rational(4);
  return resolved(shipped(drive), input);
}

model::DriveModel on_serial(const std::string& drive) {
  ResolveInput input = kinco_axis();
  input.constants["rated_current_a"] = Rational(4);
  return resolved(shipped(drive), input);
}

std::vector<Quantity> lost(const model::DriveModel& there, const model::DriveModel& here) {
  std::vector<Quantity> out;
  for (const QuantityRow& row : quantity_table())
    if ((there.axes[0].supported & ~here.axes[0].supported & bit(row.quantity)) != 0) out.push_back(row.quantity);
  return out;
}

TEST(KincoRtu, GivesWhatItsManualListsARegisterFor) {
  EXPECT_THAT(lost(on_serial("kinco-jd"), on_rtu("kinco-jd")),
              ElementsAre(Quantity::drive_temperature, Quantity::dc_voltage));
  EXPECT_THAT(lost(on_serial("kinco-md"), on_rtu("kinco-md")), ElementsAre());
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    EXPECT_THAT(lost(on_rtu(drive), on_serial(drive)), ElementsAre()) << drive;
    EXPECT_EQ(on_rtu(drive).axes[0].supported_commands, on_serial(drive).axes[0].supported_commands) << drive;
    EXPECT_EQ(on_rtu(drive).axes[0].modes, on_serial(drive).axes[0].modes) << drive;
  }
}

TEST(KincoRtu, TheSecondFaultWordHasNoRegister) {
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    const model::DriveModel model = on_rtu(drive);
    EXPECT_EQ(model.axes[0].fault_words[1], model::kNoObject);
    EXPECT_EQ(binding(model, Quantity::vendor_error).bits.size(), 1U);
    EXPECT_EQ(model.alarms.size(), 16U) << drive << ": those of the first word";
  }
}

TEST(KincoRtu, TellsItsLine) {
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    const model::DriveModel model = on_rtu(drive);
    EXPECT_EQ(model.protocol, "modbus-rtu");
    EXPECT_TRUE(model.rtu.low_word_first);
    EXPECT_EQ(model.rtu.max_registers, 2);
    EXPECT_THAT(model.rtu.runs, ElementsAre()) << "its registers are not contiguous";
    EXPECT_THAT(model.rtu.error_functions, ElementsAre(0x81));
    EXPECT_EQ(model.rtu.broadcast, std::nullopt);
  }
}

/// "statusword/1 position_actual/2"
std::string resyncs(const model::DriveModel& model) {
  std::string out;
  for (const model::ResyncRead& read : model.resync.candidates)
    out += (out.empty() ? "" : " ") + model.object(read.object).name + "/" + std::to_string(read.registers);
  return out;
}

TEST(Rtu, ResynchronisationReadsDifferInLengthOnly) {
  EXPECT_EQ(resyncs(on_rtu("kinco-jd")), "statusword/1 position_actual/2");
  EXPECT_EQ(resyncs(on_rtu("kinco-md")), "statusword/1 position_actual/2");
  EXPECT_EQ(resyncs(resolved(shipped("id286pro"), one_axis("modbus-rtu"))),
            "fault_code/1 fault_code/2 microstep_in_effect/3 fault_code/4");
  EXPECT_EQ(resyncs(resolved(valid_file("virtual"), one_axis("modbus-rtu"))), "fault_code/1 fault_code/3 position/2");
  EXPECT_TRUE(on_rtu("kinco-jd").resync.by_length);
}

TEST(Rtu, FactsOfTheLineAreTheProfiles) {
  const model::RtuProperties facts = resolved(valid_file("virtual"), one_axis("modbus-rtu")).rtu;
  EXPECT_FALSE(facts.low_word_first);
  EXPECT_EQ(facts.max_registers, 8);
  EXPECT_THAT(facts.runs, ElementsAre(Pair(10, 13), Pair(100, 109)));
  EXPECT_THAT(facts.error_functions, ElementsAre(0x81, 0xFF));
  EXPECT_EQ(facts.answer, std::chrono::milliseconds(5));
  EXPECT_EQ(resolved(valid_file("virtual-pair"), one_axis("modbus-rtu")).rtu.max_registers, 2)
      << "one 32-bit object where nothing is said";
}

}  // namespace
}  // namespace axisgate::profile
