// SPDX-License-Identifier: Apache-2.0
// What a client is shown of the axis, held against the contract and against what the motor did (3.2). Promises the
// first thing that is wrong, in words. Never asks the gateway.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/judged/history.hpp"
#include "tests/model/contract.hpp"

namespace axisgate::test::judged {

/// Registers 0 to 38 as one client has read them.
struct Shown {
  std::vector<std::uint16_t> words{};
  bool low_word_first = false;
  bool float_numbers = false;
  bool alone = true;             ///< no other master has spoken to the drive
  bool statusword_tells = true;  ///< whether it is enabled; a virtual axis tells what it was told

  /// In 1/10000 turn, and in 0.001 rpm. Only where they are valid.
  [[nodiscard]] std::int64_t position() const { return number(2, 10'000); }
  [[nodiscard]] std::int64_t velocity() const { return number(4, 1'000); }
  [[nodiscard]] std::int64_t number(std::size_t at, double units) const;
  [[nodiscard]] std::uint32_t wide(std::size_t at) const {
    const std::size_t low = low_word_first ? 0 : 1;
    return std::uint32_t{words[at + 1 - low]} << 16 | words[at + low];
  }
};

/// 3.3 Outcomes: what register 25 may tell of a request that was answered with this exception.
[[nodiscard]] bool result_fits(int exception, int result);
[[nodiscard]] std::optional<std::string> wrong_in(const Shown& shown, std::size_t client, reference::Contract& contract,
                                                  const History& history);

}  // namespace axisgate::test::judged
