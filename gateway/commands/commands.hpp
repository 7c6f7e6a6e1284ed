// SPDX-License-Identifier: Apache-2.0
// The commands that look at files, at tables or at a running gateway from outside: the options of each, and what
// carries it out. Promises every mistake of a file at once, each with its place, and an exit code: 0 done, 1 it says
// no. Never opens a port of a drive, and never moves one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

/// `axisgate check CONFIG`: validates a configuration and prints what it comes to: the plan of each bus, and the facts
/// of each axis that matter for safety.
struct CheckOptions {
  std::string config;
  std::vector<std::string> profile_folders;
};
/// 1: mistakes, or a bus over 100 %.
[[nodiscard]] int run(const CheckOptions& options);

/// `axisgate explain [WORD|CODE]`: what a state, alarm, result, exception, abort code, an ErrorID of the blocks for
/// PLCs, a drive's fault code or a word of the manual means, what usually causes it and what to do, from the table that
/// the program itself uses and from the drive profiles.
struct ExplainOptions {
  std::vector<std::string> words;  ///< "result 9" comes as two; empty: all there is
  bool page = false;               ///< docs/troubleshooting.md
  bool glossary = false;           ///< docs/glossary.md
  std::vector<std::string> profile_folders{};
};
/// What there is to say; empty: nothing is called so.
[[nodiscard]] std::string explanation(const std::string& typed, const std::vector<std::string>& profile_folders);
/// 1: nothing is called so.
[[nodiscard]] int run(const ExplainOptions& options);

/// `axisgate map CONFIG`: every register, coil and input of this gateway, for the PLC programmer, from the table that
/// the server answers from, as one listener shows it; says on stderr where another listener shows it otherwise.
struct MapOptions {
  std::string config;
  std::vector<std::string> profile_folders;
  std::string format = "table";  ///< json, csv, md, st or table
  std::string listener;          ///< its "listen", "HOST:PORT"; empty: the first one
};
[[nodiscard]] int run(const MapOptions& options);

/// `axisgate profile check FILE [--eds FILE]`: validates a drive profile, says what it gives on each protocol, and
/// holds it against the maker's EDS.
struct ProfileCheckOptions {
  std::string file;
  std::string eds;  ///< empty: none
  std::vector<std::string> profile_folders{};
};
[[nodiscard]] int run(const ProfileCheckOptions& options);

/// `axisgate reload CONFIG`: has the gateway that runs with this file read it again. Says what was changed, or why
/// nothing was, and waits for that as long as the gateway lives, not for one that hangs.
struct ReloadOptions {
  std::string config;
  Duration patience = std::chrono::seconds(5);  ///< so long at most it shows no sign of life
};
/// 1: refused, or no gateway runs with this file, or it hangs.
[[nodiscard]] int run(const ReloadOptions& options);

/// `axisgate topics [CONFIG]`: shows all axes live, as DDS subscribers see them. It becomes axisgate-dds, and listens
/// where the configuration says that the gateway speaks; returns only where it cannot.
struct TopicsOptions {
  std::string config;  ///< empty: none
  std::vector<std::string> profile_folders;
  std::optional<std::uint32_t> domain;  ///< goes before the configuration's
  std::vector<std::string> interfaces;  ///< the same
  bool all = false;                     ///< every gateway of the domain, not that of the configuration alone
  bool once = false;
  bool json = false;
};
[[nodiscard]] int run(const TopicsOptions& options);

}  // namespace axisgate::commands
