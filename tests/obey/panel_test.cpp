// SPDX-License-Identifier: Apache-2.0
// 3.1 Panels: floats in turns and rpm, and 32-bit rows by two writes of function 6, beside a PLC that counts in
// integers.
#include <gtest/gtest.h>

#include <bit>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kHostOfPanel = 40;

modbus_tcp::ListenerSettings of_panels() {
  modbus_tcp::ListenerSettings settings;
  settings.float_numbers = settings.staged_halves = true;
  return settings;
}

class Panels : public testing::TestWithParam<Subject> {
 protected:
  Panels() { plant_.ready(); }
  Answer half(std::uint16_t offset, std::uint16_t word) {
    return panel_->write({.function = fc::write_register, .first = offset, .words = {word}});
  }
  static std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }
  static std::uint16_t high(float number) { return static_cast<std::uint16_t>(bits(number) >> 16); }
  static std::uint16_t low(float number) { return static_cast<std::uint16_t>(bits(number)); }
  float shown(std::uint16_t offset) { return std::bit_cast<float>(panel_->wide(offset)); }
  void set_by_halves(std::uint16_t offset, float number) {
    ASSERT_EQ(half(offset + 1, low(number)), kOk);
    ASSERT_EQ(half(offset, high(number)), kOk);
  }
  void start() {
    ASSERT_EQ(panel_->command(0), kOk);
    ASSERT_EQ(panel_->command(kMove), kOk);
  }
  Plant plant_{GetParam()};
  std::unique_ptr<Client> panel_ = plant_.connection_from(kHostOfPanel, of_panels());
};

TEST_P(Panels, MoveByTurnsWhatAPlcSeesInItsUnits) {
  set_by_halves(row::target_position, 2.5F);
  start();
  EXPECT_NEAR(static_cast<double>(plant_.comes_to_rest_at()), 25'000, kClose);
  plant_.run(500ms);
  EXPECT_NEAR(shown(shown::position), 2.5, 0.001);
  EXPECT_NEAR(plant_.b.wide(shown::position), 25'000, kClose);
  ASSERT_EQ(panel_->row(row::target_position, bits(-0.25F)), kOk);
  start();
  EXPECT_NEAR(static_cast<double>(plant_.comes_to_rest_at()), -2'500, kClose);
}

TEST_P(Panels, MoveNowhereByHalvesThatDoNotBelongTogether) {
  set_by_halves(row::target_position, 2.0F);
  ASSERT_EQ(half(row::target_position, high(40.0F)), kOk);
  ASSERT_EQ(panel_->command(kQuickStop), kOk);
  ASSERT_EQ(half(row::target_position + 1, low(40.001F)), kOk);  // alone again
  plant_.run(2s);
  EXPECT_EQ(panel_->result(), 6);
  EXPECT_EQ(panel_->wide(shown::detail), 0x0A00'0000 + row::target_position);
  ASSERT_EQ(panel_->command(kEnable), kOk);
  start();
  EXPECT_NEAR(static_cast<double>(plant_.comes_to_rest_at()), 20'000, kClose);
}

TEST_P(Panels, AreRefusedWhatIsNoNumber) {
  for (const std::uint32_t none : {0x7FC0'0000U, 0x7F80'0000U, 0xFF80'0000U, bits(1e9F)})
    EXPECT_EQ(panel_->row(row::target_position, none), kBadValue);
  EXPECT_EQ(panel_->write(block(row::mode, row::target_position + 1, {{row::target_position, 0x7FC0'0000}})),
            kBadValue);
  EXPECT_EQ(panel_->wide(shown::detail), 0x0A00'0000 + row::target_position);
  EXPECT_TRUE(plant_.stands());
}

INSTANTIATE_TEST_SUITE_P(Every, Panels, testing::ValuesIn(subjects(has_positions)), named);

}  // namespace
}  // namespace axisgate::test::obey
