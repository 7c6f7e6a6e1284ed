// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/plan/scan_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "gateway/commands/scan/plan/drive_to_paste.hpp"

namespace axisgate::commands {
namespace {

constexpr std::size_t kColumns = 8;
using Row = std::array<std::string, kColumns>;

std::string number(const std::optional<std::uint32_t>& value) { return value ? fmt::format("{:#010x}", *value) : "-"; }

std::string fit_text(const ScanFit& fit) { return fmt::format("{} ({} of {} objects)", fit.profile, fit.has, fit.of); }

Row row_of(const FoundNode& node) {
  constexpr std::array<std::string_view, 4> kStates{"-", "stopped", "pre-operational", "operational"};
  return {fmt::format("{:>4}", node.node),
          node.name.empty() ? "-" : node.name,
          number(node.identity[0]),
          number(node.identity[1]),
          number(node.identity[2]),
          number(node.identity[3]),
          std::string(kStates[static_cast<std::size_t>(node.state)]),
          node.fits.empty() ? "none fits" : fit_text(node.fits.front())};
}

std::vector<std::string> remarks_of(const FoundNode& node) {
  std::vector<std::string> out;
  std::vector<std::string> others;
  for (std::size_t i = 1; i < node.fits.size(); ++i)
    if (node.fits[i].by != ScanFit::By::device_type) others.push_back(fit_text(node.fits[i]));
  if (!others.empty() && node.fits[0].has < node.fits[0].of)
    out.push_back(fmt::format("{} fits best; less: {}", node.fits[0].profile, fmt::join(others, ", ")));
  if (!node.fits.empty() && node.fits[0].by == ScanFit::By::device_type)
    out.push_back(
        fmt::format("no profile is for this drive (vendor {}): {} is for any CiA 402 drive, and moves nothing before "
                    "its units are known",
                    number(node.identity[0]), node.fits[0].profile));
  if (!node.fits.empty() && node.fits[0].only_simulated)
    out.push_back(fmt::format("{}: {}", node.fits[0].profile, model::kOnlySimulated));
  if (!node.of_vendor.empty())
    out.push_back(
        fmt::format("for other products or revisions of this vendor there is {}", fmt::join(node.of_vendor, ", ")));
  if (!node.nameless.empty())
    out.push_back(
        fmt::format("{} would fit, but says of no vendor: its \"identity\" would", fmt::join(node.nameless, ", ")));
  if (node.fits.empty() && node.device_type)
    out.push_back(fmt::format("device type (1000h) {:#010x}: CiA {}", *node.device_type, *node.device_type & 0xFFFFU));
  if (node.fell_silent)
    out.emplace_back("it fell silent while it was asked: what follows its last answer is not known");
  if (node.duplicate)
    out.emplace_back(
        "two answers came to one request: two devices have this node-ID, or somebody else asks it, such as a gateway "
        "that runs");
  return out;
}

/// Vendor and product alone: with revision or serial number, a drive put in the place of this one would be refused.
std::string entry_of(const FoundNode& node) {
  std::vector<std::string> identity;
  constexpr std::array<std::string_view, 2> kNumbers{"vendor", "product"};
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    if (node.identity[i]) identity.push_back(fmt::format("\"{}\": {}", kNumbers[i], *node.identity[i]));
  return drive_to_paste(node.fits.front(), node.node, fmt::format("{}", fmt::join(identity, ", ")), "  ");
}

std::string aligned(const std::vector<Row>& rows) {
  std::array<std::size_t, kColumns> width{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < kColumns; ++i) width[i] = std::max(width[i], row[i].size());
  std::string out;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < kColumns; ++i) out += fmt::format("{:<{}}  ", row[i], width[i]);
    out += row.back() + "\n";
  }
  return out;
}

}  // namespace

std::string scan_table(const std::vector<FoundNode>& nodes) {
  if (nodes.empty()) return {};
  std::vector<Row> rows{{"node", "name", "vendor", "product", "revision", "serial", "heartbeat", "profile"}};
  std::vector<std::string> remarks;
  std::vector<std::string> entries;
  for (const FoundNode& node : nodes) {
    rows.push_back(row_of(node));
    for (const std::string& remark : remarks_of(node))
      remarks.push_back(fmt::format("node {}: {}\n", node.node, remark));
    if (!node.fits.empty()) entries.push_back(entry_of(node));
  }
  std::string out = aligned(rows);
  if (!remarks.empty()) out += fmt::format("\n{}", fmt::join(remarks, ""));
  if (!entries.empty())
    out += fmt::format("\n\"drives\" of a configuration (the axis numbers are yours to choose{}):\n{}\n",
                       to_fill_in(entries), fmt::join(entries, ",\n"));
  return out;
}

}  // namespace axisgate::commands
