// SPDX-License-Identifier: Apache-2.0
// The numbers by which clients are told how a request has ended (register 25, CommandReply.result).
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "gateway/core/error.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate {
namespace {

constexpr int kLastResult = 11, kFirstOfDdsAlone = 16;

TEST(Results, AreTheSameNumbersInRegistersAndInDds) {
  std::set<int> used{0, 1};  // none, pending
  for (int code = 0; code < kErrcCount; ++code) {
    const auto errc = static_cast<Errc>(code);
    const int result = static_cast<int>(command_result(errc));
    EXPECT_LE(result, kLastResult) << text(errc);
    if (result != 0) {
      EXPECT_EQ(dds_result(errc), result) << text(errc);
    } else {
      EXPECT_GE(dds_result(errc), kFirstOfDdsAlone) << text(errc);
    }
    used.insert(result);
  }
  EXPECT_EQ(used.size(), kLastResult + 1U) << "each number is one that a client may read";
}

TEST(Results, OfAStateThatDidNotComeIsElevenAndOfALostAcknowledgementFour) {
  EXPECT_EQ(command_result(Errc::not_reached), CommandResult::not_reached);
  EXPECT_EQ(modbus_exception(Errc::not_reached), ModbusException::server_device_failure);
  for (int code = 0; code < kErrcCount; ++code) {
    const auto errc = static_cast<Errc>(code);
    const bool unknown = command_result(errc) == CommandResult::outcome_unknown;
    EXPECT_EQ(modbus_exception(errc) == ModbusException::gateway_target_failed, unknown) << text(errc);
  }
}

TEST(Results, AreAllNamedWhereTheRegisterIsDocumented) {
  constexpr std::uint16_t kRegister = 25;
  const RegisterRow* row = register_table(Block::axis).covering(kRegister);
  ASSERT_NE(row, nullptr);
  const std::string page = ", " + std::string(row->note);
  for (int number = 0; number <= kLastResult; ++number)
    EXPECT_NE(page.find(", " + std::to_string(number) + " "), std::string::npos) << number;
}

}  // namespace
}  // namespace axisgate
