// SPDX-License-Identifier: Apache-2.0
// One run: a program before the shipped gateway on its settable clock, judged against the reference model after every
// 5 ms of it. Promises equal runs for equal programs, and the first violation with all that led to it. Never decides
// what is right: the model does.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "tests/judged/cable_watch.hpp"
#include "tests/judged/nemesis.hpp"
#include "tests/judged/program.hpp"
#include "tests/model/contract.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

struct Outcome {
  std::optional<std::string> violation{};
  std::vector<std::string> story{};  ///< one line for each step
  bool lost_count = false;           ///< of the readings: from there on nothing was judged
  std::int64_t virtual_ms = 0;
  std::size_t writes = 0;
  Traffic traffic{};
  Injected injected{};
  std::vector<std::string> last_second{};  ///< the frames before a violation
};

[[nodiscard]] Outcome play(const Program& program, std::uint64_t seed);

}  // namespace axisgate::test::judged
