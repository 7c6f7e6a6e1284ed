// SPDX-License-Identifier: Apache-2.0
// How a run begins: the drive enabled, with what programs need, and what the contract is told of it. Promises that
// nobody owns the axis, and that neither a nor b has written anything. Throws where the gateway refuses it.
#pragma once

#include "tests/judged/program.hpp"
#include "tests/model/contract.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

struct Beginning {
  reference::ContractOptions options{};
  reference::World world{};
  std::uint32_t commands = 0;    ///< register 36, one bit for each that the drive has
  reference::Rows parameters{};  ///< what it holds in the rows 46, 47 and 62 to 76 that it has
};

/// What the axis's lease is like, each in some of the runs.
[[nodiscard]] LeaseRules lease_of(const Program& program, std::uint64_t seed);
/// `limits.velocity` of the axis; none: there is none.
[[nodiscard]] std::optional<std::int64_t> velocity_limit(Subject subject, std::uint64_t seed);
/// So many clients of Modbus are programs at one address, with a connection each.
[[nodiscard]] std::size_t together(std::uint64_t seed);
[[nodiscard]] Beginning begin(obey::Plant& plant, const Program& program, std::uint64_t seed);

}  // namespace axisgate::test::judged
