// SPDX-License-Identifier: Apache-2.0
// The steps of a run with all that they can be shrunk to. Apart from program.hpp, for what only a failure needs.
#pragma once

#include <rapidcheck/Shrinkable.h>

#include "tests/judged/program.hpp"

namespace axisgate::test::judged {

[[nodiscard]] Flavour flavour_of(Subject subject, std::uint64_t seed);
[[nodiscard]] rc::Shrinkable<std::vector<Step>> steps_of(Subject subject, Weather weather, std::uint64_t seed);

}  // namespace axisgate::test::judged
