// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/plan/drive_to_paste.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/config/config.hpp"

namespace axisgate::commands {

std::string drive_to_paste(const ScanFit& fit, int node, const std::string& identity, const std::string& indent) {
  std::string out = fmt::format("{}{{\"profile\": \"{}\", \"node\": {}, ", indent, fit.profile, node);
  if (!identity.empty()) out += fmt::format("\"identity\": {{{}}}, ", identity);
  if (!fit.wanted.empty()) out += "\"constants\": {\n";
  for (const profile::WantedConstant& wanted : fit.wanted) {
    const bool last = &wanted == &fit.wanted.back();
    // A line break in the text would end the comment.
    std::string text = wanted.text.empty() ? "see the drive's manual" : wanted.text;
    std::ranges::replace(text, '\n', ' ');
    out += fmt::format("{}  \"{}\": \"{}\"{} // {}\n", indent, wanted.name, config::kFillIn, last ? "" : ",", text);
  }
  if (!fit.wanted.empty()) out += indent + "}, ";
  return out + fmt::format("\"axes\": [{{\"axis\": {}}}]}}", node);
}

std::string to_fill_in(const std::vector<std::string>& drives) {
  const auto has_one = [](const std::string& drive) { return drive.find(config::kFillIn) != std::string::npos; };
  if (!std::ranges::any_of(drives, has_one)) return "";
  return fmt::format("; for each \"{}\" write the number from the type plate of drive or motor, or from the manual",
                     config::kFillIn);
}

}  // namespace axisgate::commands
