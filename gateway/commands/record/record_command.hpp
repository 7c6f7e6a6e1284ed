// SPDX-License-Identifier: Apache-2.0
// `axisgate record AXIS...`: what axes did, as CSV, from the history of a running gateway's page.
// Promises each sample that the page's history had, once, and says so where it had not all. Never asks a drive for
// anything, and never asks the gateway: the page answers by itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

struct RecordOptions {
  std::vector<std::string> axes;  ///< numbers, or names as the page has them
  std::uint32_t seconds = 10;     ///< from now on
  std::uint32_t before = 0;       ///< instead: the seconds before now, at once
  std::string series;             ///< names of values with commas between; empty: a sensible five
  std::string output;             ///< a file; empty: standard output
  std::string url = "http://127.0.0.1:8080/";
  std::string config;  ///< takes the page's address from this file; empty: `url` has it
  std::vector<std::string> profile_folders{};
  Duration pause = std::chrono::seconds(1);  ///< before a page that is full, or away, is asked again
};

/// Exit status: 0 done, or ended by Ctrl-C with what there was by then; 1 no page, no such axis, or not all of it was
/// there; 2 for options that are none.
[[nodiscard]] int run(const RecordOptions& options);

}  // namespace axisgate::commands
