// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/plan/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::commands::support {
namespace {

/// To whole lines where it has any.
void cut(Gathered& file, std::size_t most) {
  const std::size_t whole = file.text.size();
  if (whole <= most) return;
  if (file.newest_is_last) {
    file.text.erase(0, whole - most);
    if (const std::size_t line = file.text.find('\n'); line + 1 < file.text.size()) file.text.erase(0, line + 1);
  } else {
    file.text.resize(most);
    if (const std::size_t line = file.text.rfind('\n'); line != std::string::npos) file.text.resize(line + 1);
  }
  const std::string said = fmt::format("{} bytes of {} are here: there is room for no more", file.text.size(), whole);
  file.why_not += file.why_not.empty() ? said : "; " + said;
}

}  // namespace

std::vector<Gathered> fit(std::vector<Gathered> files, const Redaction& redaction) {
  std::size_t left = kMostOfAll;
  for (Gathered& file : files) {
    file.text = scrubbed(std::move(file.text), redaction);
    file.why_not = scrubbed(std::move(file.why_not), redaction);
    cut(file, std::min(left, kMostOfFile));
    left -= file.text.size();
  }
  return files;
}

std::string manifest(const std::vector<Gathered>& files, const Redaction& redaction, const std::string& made,
                     const std::string& version) {
  std::string out = fmt::format("Made by axisgate {} at {}.\n\nIn it:\n", version, made);
  for (const Gathered& file : files)
    if (!file.text.empty()) out += fmt::format("  {:<20} {:>9} bytes  {}\n", file.file, file.text.size(), file.what);
  out += "\nTaken out:\n  comments of the configuration, users' names in paths of their homes\n";
  for (const std::string& place : redaction.left_out) out += fmt::format("  {}\n", place);
  out +=
      "Not taken out: names of axes and buses, devices, network addresses. No profile, no file of DDS-Security and\n"
      "no key goes along.\n";
  bool said = false;
  for (const Gathered& file : files) {
    if (file.why_not.empty()) continue;
    if (!std::exchange(said, true)) out += "\nNot there, or not all of it:\n";
    out += fmt::format("  {:<20} {}\n", file.file, file.why_not);
  }
  return out;
}

}  // namespace axisgate::commands::support
