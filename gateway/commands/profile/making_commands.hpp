// SPDX-License-Identifier: Apache-2.0
// The commands that make a profile: the options of each, and what carries it out.
// Promises a file that axisgate profile check takes, with the questions that its source leaves open, or the reasons why
// there is none. Never writes over a file, and never writes to a drive.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::commands {

/// `axisgate profile from-eds FILE`: a profile that says what the drive of this EDS or DCF has otherwise than any CiA
/// 402 drive.
struct ProfileFromEdsOptions {
  std::string file;
  std::string name;  ///< empty: by the product's name
  std::string folder = ".";
  std::string node;  ///< "can0:5": a drive that is asked as well, by reads alone; empty: none
  std::uint32_t bitrate = 500'000;
  std::vector<std::string> profile_folders{};
};
/// 1: no profile can be made of it, or one that something stands against.
[[nodiscard]] int run(const ProfileFromEdsOptions& options);

/// `axisgate profile new --modbus CSV`: a form of a profile, from a table that a manual's is copied into.
struct ProfileNewOptions {
  std::string modbus, canopen;  ///< the table; one of them
  std::string like;             ///< a profile whose commands and state it takes; empty: none
  std::string name;             ///< empty: by the table's file name
  std::string folder = ".";
  std::vector<std::string> profile_folders{};
};
[[nodiscard]] int run(const ProfileNewOptions& options);

/// `axisgate profile upgrade FILE`: a profile that was written for an earlier axisgate, in the words of this one.
struct ProfileUpgradeOptions {
  std::string file;
  std::string folder = ".";
  std::vector<std::string> profile_folders{};
};
[[nodiscard]] int run(const ProfileUpgradeOptions& options);

}  // namespace axisgate::commands
