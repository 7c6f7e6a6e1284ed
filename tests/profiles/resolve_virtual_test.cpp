// SPDX-License-Identifier: Apache-2.0
// A drive that is no CiA 402 one, resolved: the gateway's own objects, what the state is made from, codes and values.
#include <gmock/gmock.h>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using testing::Pair;

model::DriveModel virtual_drive() { return resolved(valid_file("virtual"), one_axis("modbus-rtu")); }

TEST(VirtualDrive, HasAStatuswordAControlwordAndAModeThatTheGatewayMakes) {
  const model::DriveModel model = virtual_drive();
  const model::AxisModel& axis = model.axes[0];
  const std::vector<model::ObjectId> emulated{axis.statusword, axis.controlword, axis.mode};
  EXPECT_THAT(names(model, emulated), ElementsAre("statusword", "controlword", "mode"));
  for (const model::ObjectId id : emulated) {
    EXPECT_TRUE(model.object(id).emulated);
    EXPECT_TRUE(model.object(id).readable);
    EXPECT_EQ(model.object(id).slot, 0);
  }
  EXPECT_EQ(model.object(axis.statusword).size, 2);
  EXPECT_FALSE(model.object(axis.statusword).writable);
  EXPECT_TRUE(model.object(axis.controlword).writable);
  EXPECT_EQ(model.object(axis.mode).range(), (Range{-128, 127}));
  for (std::size_t i = 0; i < model.objects.size(); ++i)
    EXPECT_EQ(model.objects[i].emulated, std::find(emulated.begin(), emulated.end(), i) != emulated.end())
        << model.objects[i].name;
  EXPECT_EQ(model.find({0, 0}), model::kNoObject) << "they have no address of the drive";
}

TEST(VirtualDrive, SupportsWhatTheGatewayMakes) {
  const model::DriveModel model = virtual_drive();
  const model::AxisModel& axis = model.axes[0];
  for (const Quantity q : {Quantity::statusword, Quantity::mode_display, Quantity::controlword, Quantity::mode})
    EXPECT_NE(axis.supported & bit(q), 0U) << row(q).name;
  EXPECT_EQ(axis.writable & bit(Quantity::statusword), 0U);
  EXPECT_NE(axis.writable & bit(Quantity::controlword), 0U);
  EXPECT_NE(axis.writable & bit(Quantity::mode), 0U);
  EXPECT_EQ(binding(model, Quantity::statusword).poll, model::PollClass::fast);
  EXPECT_EQ(binding(model, Quantity::mode_display).poll, model::PollClass::fast);
  EXPECT_EQ(binding(model, Quantity::mode_display).object, axis.mode);
  EXPECT_EQ(axis.mode_display, axis.mode);
  EXPECT_TRUE(axis.cia402.setpoint_acknowledge);
  EXPECT_EQ(binding(model, Quantity::controlword).limits, (Range{0, 65534}));
  EXPECT_EQ(binding(model, Quantity::mode).limits, (Range{-128, 127}));
}

TEST(VirtualDrive, ItsStateIsEmulatedFromTheFaultFirst) {
  const model::DriveModel model = virtual_drive();
  EXPECT_THAT(names(model, model.axes[0].state_sources), ElementsAre("fault_code", "run_state"));
  const model::DriveModel kinco = resolved(shipped("kinco-jd"), kinco_axis());
  EXPECT_THAT(names(kinco, kinco.axes[0].state_sources), ElementsAre("statusword"));
  EXPECT_FALSE(kinco.axes[0].virtual_axis);
}

TEST(VirtualDrive, TellsItsMachineWhatItGoesBy) {
  const model::DriveModel model = virtual_drive();
  const auto& facts = model.axes[0].virtual_axis;
  ASSERT_TRUE(facts);
  EXPECT_EQ(model.object(facts->fault.object).name, "fault_code");
  EXPECT_TRUE(facts->fault.holds(model.object(facts->fault.object), 14));
  EXPECT_TRUE(facts->enabled.holds(model.object(facts->enabled.object), 3));
  EXPECT_FALSE(facts->limit);
  ASSERT_TRUE(facts->reached);
  EXPECT_EQ(facts->within, 4);
  ASSERT_TRUE(facts->homed_at);
  EXPECT_FALSE(facts->gate_only);
  EXPECT_FALSE(facts->quick_stop_energised);
  ASSERT_TRUE(model.axes[0].moving);
  EXPECT_TRUE(model.axes[0].moving->holds(model.object(facts->enabled.object), 3));
}

TEST(VirtualDrive, OfTwoMotorsHasObjectsForEach) {
  ResolveInput input = one_axis("modbus-rtu");
  input.axes.emplace_back();
  const model::DriveModel model = resolved(valid_file("virtual-pair"), input);
  ASSERT_EQ(model.axes.size(), 2U);
  EXPECT_THAT(names(model, {model.axes[0].statusword, model.axes[1].statusword, model.axes[1].mode}),
              ElementsAre("A.statusword", "B.statusword", "B.mode"));
  EXPECT_EQ(model.object(model.axes[1].controlword).slot, 1);
  EXPECT_THAT(names(model, model.axes[1].state_sources), ElementsAre("fault", "B.run_state"));
  EXPECT_EQ(model.axes[1].virtual_axis->within, 0);
  EXPECT_TRUE(model.axes[1].virtual_axis->quick_stop_energised);
}

TEST(VirtualDrive, HomingMethodsAreTranslatedBothWays) {
  const model::DriveModel model = virtual_drive();
  const model::Binding& method = binding(model, Quantity::homing_method);
  EXPECT_THAT(method.codes, ElementsAre(Pair(17, 3), Pair(18, 2), Pair(35, 4)));
  EXPECT_EQ(method.limits, (Range{17, 35}));
  EXPECT_EQ(method.to_register(2), 18);
  EXPECT_EQ(method.to_register(0), std::nullopt) << "a mode of the drive that no method stands for";
  EXPECT_EQ(sent(model, Quantity::homing_method, 35), 4);
  EXPECT_EQ(sent(model, Quantity::homing_method, 19), std::nullopt);
  EXPECT_TRUE(binding(resolved(shipped("kinco-md"), kinco_axis()), Quantity::homing_method).codes.empty());
}

TEST(VirtualDrive, TakesAPositionByValueAndNeedsNoModeForIt) {
  const model::DriveModel model = virtual_drive();
  const auto& command = model.axes[0].command(Command::set_position);
  ASSERT_TRUE(command);
  EXPECT_FALSE(command->zero_only);
  ASSERT_EQ(command->steps.size(), 2U);
  EXPECT_EQ(command->steps[0].source, model::Step::Source::set_position);
  EXPECT_EQ(command->steps[0].quantity, Quantity::position_actual);
  EXPECT_EQ(model.object(command->steps[0].object).name, "new_position");
  EXPECT_EQ(command->steps[1].source, model::Step::Source::literal);
}

TEST(VirtualDrive, OnlyRunVelocityRepeatsOnChange) {
  const model::DriveModel model = virtual_drive();
  for (std::uint16_t number = 1; number <= kLastCommand; ++number) {
    const auto& command = model.axes[0].commands[number];
    const bool repeats = command && command->repeat_on_change;
    EXPECT_EQ(repeats, number == static_cast<std::uint16_t>(Command::run_velocity)) << number;
  }
  EXPECT_FALSE(resolved(shipped("kinco-jd"), kinco_axis()).axes[0].command(Command::run_velocity)->repeat_on_change);
}

TEST(VirtualDrive, AlarmsByValueKeepTheirOrder) {
  const model::DriveModel model = virtual_drive();
  ASSERT_EQ(model.alarms.size(), 2U);
  EXPECT_EQ(model.alarms[0].value, 14U);
  EXPECT_EQ(model.alarms[0].code, 0x3210);
  EXPECT_EQ(model.alarms[1].value, 10U);
  for (const model::AlarmRow& row : resolved(shipped("kinco-jd"), kinco_axis()).alarms)
    EXPECT_FALSE(row.value) << row.text;
}

}  // namespace
}  // namespace axisgate::profile
