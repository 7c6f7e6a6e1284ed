// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/register_map.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "gateway/listing/map_page.hpp"
#include "tests/places.hpp"

namespace axisgate {
namespace {

using enum RegisterType;

/// A row as design 3.1 prints it; bit -1 where the column is empty.
struct Printed {
  int offset;
  const char* name;
  RegisterType type;
  bool rw;
  int bit;
};

// Copied from the contract by hand: this is the one place where the two are compared.
constexpr Printed kAxis[] = {
    {0, "statusword", u16, false, 0},
    {1, "mode_display", i16, false, 1},
    {2, "position_actual", i32, false, 2},
    {4, "velocity_actual", i32, false, 3},
    {6, "torque_actual", i16, false, 4},
    {7, "current_actual", i16, false, 5},
    {8, "following_error", i32, false, 6},
    {10, "error_code", u16, false, 7},
    {11, "digital_inputs", u16, false, 9},
    {12, "vendor_error", u32, false, 8},
    {14, "digital_outputs", u16, false, 10},
    {15, "drive_temperature", i16, false, 11},
    {16, "motor_temperature", i16, false, 12},
    {17, "dc_voltage", u16, false, 13},
    {18, "link_state", u16, false, -1},
    {19, "age_ms", u16, false, -1},
    {20, "supported", u32, false, -1},
    {22, "valid", u32, false, -1},
    {24, "sequence", u16, false, -1},
    {25, "command_result", u16, false, -1},
    {26, "command_detail", u32, false, -1},
    {28, "owner", u16, false, -1},
    {29, "lease_remaining_ms", u16, false, -1},
    {30, "command_id_seen", u16, false, -1},
    {31, "axis_state", u16, false, -1},
    {32, "motion_state", u16, false, -1},
    {33, "motion_id", u16, false, -1},
    {34, "axis_alarms", u32, false, -1},
    {36, "supported_commands", u32, false, -1},
    {38, "supported_modes", u16, false, -1},
    {40, "controlword", u16, true, 14},
    {41, "mode", i16, true, 15},
    {42, "target_position", i32, true, 16},
    {44, "target_velocity", i32, true, 17},
    {46, "target_torque", i16, true, 18},
    {47, "max_torque", u16, true, 19},
    {48, "profile_velocity", u32, true, 20},
    {50, "profile_acceleration", u32, true, 21},
    {52, "profile_deceleration", u32, true, 22},
    {54, "command", u16, true, -1},
    {55, "command_id", u16, true, -1},
    {56, "heartbeat", u16, true, -1},
    {58, "jog_velocity", u32, true, -1},
    {60, "homing_method", i16, true, 23},
    {62, "homing_speed_switch", u32, true, 24},
    {64, "homing_speed_zero", u32, true, 25},
    {66, "homing_acceleration", u32, true, 26},
    {68, "homing_offset", i32, true, 27},
    {70, "quick_stop_deceleration", u32, true, 28},
    {72, "position_limit_min", i32, true, 29},
    {74, "position_limit_max", i32, true, 30},
    {76, "max_velocity", u32, true, 31},
    {78, "set_position_value", i32, true, -1},
    {80, "object_request", u16, true, -1},
    {81, "object_index", u16, true, -1},
    {82, "object_subindex", u16, true, -1},
    {83, "object_size", u16, true, -1},
    {84, "object_data", u32, true, -1},
    {86, "object_status", u16, false, -1},
    {88, "object_detail", u32, false, -1},
    {90, "units_per_rev_numerator", u32, false, -1},
    {92, "units_per_rev_denominator", u32, false, -1},
    {94, "rated_speed", u32, false, -1},
    {96, "owner_address", u32, false, -1},
    {98, "loss_stop_ms", u16, false, -1},
};
constexpr Printed kOverview[] = {
    {0, "statusword", u16, false, 0},      {1, "mode_display", i16, false, 1},  {2, "position_actual", i32, false, 2},
    {4, "velocity_actual", i32, false, 3}, {6, "torque_actual", i16, false, 4}, {7, "error_code", u16, false, 7},
    {8, "link_state", u16, false, -1},     {9, "sequence", u16, false, -1},
};
constexpr Printed kGateway[] = {
    {0, "map_version", u16, false, -1}, {1, "axis_count", u16, false, -1}, {2, "gateway_state", u16, false, -1},
    {3, "axes_online", u16, false, -1}, {4, "uptime_s", u32, false, -1},   {6, "alarms", u16, false, -1},
    {7, "role", u16, false, -1},        {8, "heartbeat", u16, true, -1},   {10, "word_order_test", u32, false, -1},
};
constexpr Printed kBus[] = {
    {0, "link", u16, false, -1},           {1, "load", u16, false, -1},        {2, "cycle_ms", u16, false, -1},
    {3, "queue_depth", u16, false, -1},    {4, "requests", u32, false, -1},    {6, "replies", u32, false, -1},
    {8, "timeouts", u32, false, -1},       {10, "bad_frames", u32, false, -1}, {12, "late_replies", u32, false, -1},
    {14, "dropped_bytes", u32, false, -1}, {16, "refused", u32, false, -1},    {18, "coalesced", u32, false, -1},
    {20, "superseded", u32, false, -1},    {22, "reconnects", u32, false, -1}, {24, "echoes", u32, false, -1},
};

template <std::size_t N>
void expect_as_printed(Block block, const Printed (&printed)[N]) {
  const auto rows = register_table(block).rows();
  ASSERT_EQ(rows.size(), N);
  for (std::size_t i = 0; i < N; ++i) {
    SCOPED_TRACE(printed[i].name);
    EXPECT_EQ(rows[i].offset, printed[i].offset);
    EXPECT_EQ(rows[i].name, printed[i].name);
    EXPECT_EQ(rows[i].type, printed[i].type);
    EXPECT_EQ(rows[i].writable, printed[i].rw);
    const bool has_bit = rows[i].source == Source::quantity;
    EXPECT_EQ(has_bit ? static_cast<int>(rows[i].quantity) : -1, printed[i].bit);
  }
}

TEST(RegisterMap, AxisBlockIsAsTheContractPrintsIt) { expect_as_printed(Block::axis, kAxis); }
TEST(RegisterMap, OverviewIsAsTheContractPrintsIt) { expect_as_printed(Block::overview, kOverview); }
TEST(RegisterMap, GatewayBlockIsAsTheContractPrintsIt) { expect_as_printed(Block::gateway, kGateway); }
TEST(RegisterMap, BusBlockIsAsTheContractPrintsIt) { expect_as_printed(Block::bus, kBus); }

TEST(RegisterMap, LongValuesStandAtEvenOffsets) {
  for (const Block block : {Block::axis, Block::overview, Block::gateway, Block::bus})
    for (const RegisterRow& row : register_table(block).rows()) {
      EXPECT_TRUE(row.registers() == 1 || row.offset % 2 == 0) << row.name;
    }
}

TEST(RegisterMap, EveryQuantityHasOneRowInTheAxisBlock) {
  for (const QuantityRow& quantity : quantity_table()) {
    int rows = 0;
    for (const RegisterRow& row : register_table(Block::axis).rows())
      rows += row.source == Source::quantity && row.quantity == quantity.quantity ? 1 : 0;
    EXPECT_EQ(rows, 1) << quantity.name;
  }
}

TEST(RegisterMap, ARowIsFoundByEachOfItsRegisters) {
  const RegisterTable& axis = register_table(Block::axis);
  EXPECT_EQ(axis.covering(2), axis.covering(3));
  EXPECT_EQ(axis.covering(3)->name, "position_actual");
  EXPECT_EQ(axis.covering(0)->name, "statusword");
  for (const int offset : {39, 57, 61, 87, 99, 100, 60000}) {
    EXPECT_EQ(axis.covering(static_cast<std::uint16_t>(offset)), nullptr) << offset;
  }
}

TEST(RegisterMap, RolesThatMayWriteAreThoseOfTheContract) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    const Role expected = row.offset >= 80                      ? Role::viewer
                          : row.offset >= 70 && row.offset < 78 ? Role::engineer
                                                                : Role::operator_;
    EXPECT_EQ(row.may_write, expected) << row.name;
  }
  EXPECT_EQ(register_table(Block::gateway).covering(8)->may_write, Role::viewer);
}

TEST(RegisterMap, PlacesEveryAddressInItsBlock) {
  const auto at = [](int address) { return place_of(static_cast<std::uint16_t>(address)); };
  EXPECT_EQ(at(0)->block, Block::gateway);
  EXPECT_EQ(at(99)->offset, 99);
  EXPECT_EQ(at(142)->block, Block::axis);
  EXPECT_EQ(at(142)->number, 1);
  EXPECT_EQ(at(142)->offset, 42);
  EXPECT_EQ(at(49999)->number, 499);
  EXPECT_EQ(at(50104)->block, Block::bus);
  EXPECT_EQ(at(50104)->number, 1);
  EXPECT_EQ(at(50104)->offset, 4);
  EXPECT_EQ(at(60012)->block, Block::overview);
  EXPECT_EQ(at(60012)->number, 1);
  EXPECT_EQ(at(60012)->offset, 2);
  EXPECT_EQ(at(64999)->number, 499);
  EXPECT_FALSE(at(65000).has_value());
  EXPECT_FALSE(at(65535).has_value());
}

TEST(RegisterMap, AddressesAndPlacesAreInversesOfEachOther) {
  for (const Block block : {Block::axis, Block::bus, Block::overview})
    for (const std::uint16_t number : {std::uint16_t{1}, std::uint16_t{7}, std::uint16_t{99}}) {
      const auto place = place_of(address_of(block, number));
      ASSERT_TRUE(place.has_value());
      EXPECT_EQ(place->block, block);
      EXPECT_EQ(place->number, number);
      EXPECT_EQ(place->offset, 0);
    }
}

TEST(RegisterMap, CoilsAndInputsStandAtTheirOffsets) {
  ASSERT_EQ(coil_rows().size(), 10U);
  for (std::size_t i = 0; i < coil_rows().size(); ++i) EXPECT_EQ(coil_rows()[i].offset, i);
  ASSERT_EQ(input_rows().size(), 13U);
  for (std::size_t i = 0; i < input_rows().size(); ++i) EXPECT_EQ(input_rows()[i].offset, i);
  EXPECT_EQ(coil_rows()[4].name, "start_absolute");
  EXPECT_EQ(input_rows()[12].name, "stop_latched");
}

TEST(RegisterMap, ACoilNeedsTheCommandThatItAsksForAndJoggingARunAtAVelocity) {
  for (const CoilRow& coil : coil_rows()) {
    const unsigned needed = coil.offset < 8 ? static_cast<unsigned>(coil.on) : 8U;
    EXPECT_TRUE(supports(Capabilities{.supported_commands = 1U << needed}, coil)) << coil.name;
    EXPECT_FALSE(supports(Capabilities{.supported_commands = ~(1U << needed)}, coil)) << coil.name;
  }
  EXPECT_FALSE(Capabilities{.supported_commands = ~0U}.supports(Command::jog_reverse))
      << "no register value, so no bit of supported_commands";
}

TEST(RegisterMapPage, IsTheOneInSchemas) {
  const std::string path = test::source_path("schemas/register-map.md");
  if (std::getenv("AXISGATE_WRITE_PAGES") != nullptr) std::ofstream(path) << listing::register_map_page();
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), listing::register_map_page())
      << "schemas/register-map.md is not what the table says. Write it anew with\n"
         "  AXISGATE_WRITE_PAGES=1 ctest --test-dir BUILD -R RegisterMapPage";
}

}  // namespace
}  // namespace axisgate
