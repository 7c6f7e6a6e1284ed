// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/profile/eds_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

std::string line_text(const profile::EdsFault& fault) {
  return fault.line == 0 ? fault.message : fmt::format("line {}: {}", fault.line, fault.message);
}

}  // namespace

std::variant<std::string, config::ConfigFault> content_of(const std::string& file, std::size_t most) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(most + 1, '\0');
  if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || (!stream && stream.gcount() == 0 && !stream.eof()))
    return config::ConfigFault{file, "", std::string("cannot be read: ") + std::strerror(errno)};
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

std::variant<profile::Eds, std::vector<config::ConfigFault>> load_eds(const std::string& file) {
  const auto text = content_of(file, profile::kMaxEdsBytes);
  if (const auto* fault = std::get_if<config::ConfigFault>(&text)) return std::vector{*fault};
  profile::Eds eds = profile::parse_eds(std::get<std::string>(text));
  if (eds.faults.empty()) return eds;
  return faults_of(file, eds.faults);
}

std::vector<config::ConfigFault> faults_of(const std::string& file, const std::vector<profile::EdsFault>& faults) {
  std::vector<config::ConfigFault> out;
  for (const profile::EdsFault& fault : faults) out.push_back({file, "", line_text(fault)});
  return out;
}

std::string identity_text(const profile::Eds& eds) {
  std::string out = profile::plain_text(eds.vendor_name + " " + eds.product_name);
  if (eds.vendor) out += fmt::format(", vendor {:#x}", *eds.vendor);
  if (eds.product) out += fmt::format(", product {:#x}", *eds.product);
  if (eds.revision) out += fmt::format(", revision {:#x}", *eds.revision);
  return out;
}

void print_remarks(const profile::Eds& eds) {
  constexpr std::size_t kShown = 20;
  const std::size_t shown = std::min(eds.remarks.size(), kShown);
  for (std::size_t i = 0; i < shown; ++i) fmt::print("  {:<14}{}\n", "remark", line_text(eds.remarks[i]));
  if (eds.remarks_in_all > shown) fmt::print("  {:<14}and {} more of that kind\n", "", eds.remarks_in_all - shown);
}

std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  return text;
}

}  // namespace axisgate::commands
