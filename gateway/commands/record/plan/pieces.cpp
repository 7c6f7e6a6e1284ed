// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/record/plan/pieces.hpp"

#include <algorithm>

namespace axisgate::commands::record {
namespace {

/// The first record of `csv`, with its end of line: one in quotation marks does not end it.
std::string_view first_row(std::string_view csv) {
  bool quoted = false;
  for (std::size_t at = 0; at < csv.size(); ++at) {
    if (csv[at] == '"') quoted = !quoted;
    if (csv[at] == '\n' && !quoted) return csv.substr(0, at + 1);
  }
  return csv;
}

std::string_view time_of(std::string_view row) { return row.substr(0, row.find(',')); }

/// Between the first comma and the last one that is not in quotation marks.
std::string_view values_of(std::string_view row) {
  std::size_t last = std::string_view::npos;
  bool quoted = false;
  for (std::size_t at = 0; at < row.size(); ++at) {
    if (row[at] == '"') quoted = !quoted;
    if (row[at] == ',' && !quoted) last = at;
  }
  const std::size_t first = row.find(',');
  return last == first ? std::string_view() : row.substr(first + 1, last - first - 1);
}

bool has_event(std::string_view row) {
  while (row.ends_with('\n') || row.ends_with('\r')) row.remove_suffix(1);
  return !row.ends_with(',');
}

}  // namespace

std::vector<Piece> pieces_of(UtcNs from, UtcNs to) {
  std::vector<Piece> out;
  for (UtcNs at = from; at < to; at += kLongestPiece) out.push_back({at, std::min(to, at + kLongestPiece), false});
  if (out.empty()) out.push_back({from, to, false});
  out.back().last = true;
  return out;
}

// What stands behind the end of a piece stands in the next as well; what stands before its begin, in the one before.
bool Joiner::wanted(std::string_view row, const Piece& piece) const {
  const std::string_view time = time_of(row);
  if (!piece.last && time >= utc_text(piece.to)) return false;
  if (!newest_) return true;
  const std::string from = utc_text(piece.from);
  return time > from || (time == from && (has_event(row) || values_of(row) != newest_));
}

std::optional<std::string> Joiner::take(std::string_view csv, const Piece& piece) {
  const std::string_view columns = first_row(csv);
  if (!columns.starts_with("time,") || (!columns_.empty() && columns != columns_)) return std::nullopt;
  std::string out;
  if (columns_.empty()) out = columns_ = columns;
  csv.remove_prefix(columns.size());
  while (!csv.empty()) {
    const std::string_view row = first_row(csv);
    csv.remove_prefix(row.size());
    if (!wanted(row, piece)) continue;
    out += row;
    newest_ = values_of(row);
  }
  return out;
}

}  // namespace axisgate::commands::record
