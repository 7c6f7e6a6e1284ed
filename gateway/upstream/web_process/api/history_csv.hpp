// SPDX-License-Identifier: Apache-2.0
// Lines and events as one table (RFC 4180): a row for each instant at which a value was sampled or something happened,
// with what the registers showed then. Pure: points in, pieces of text out.
// Promises that it is made while it is taken, so that a long one takes no more room than a short one; numbers without
// an exponent, and text on one line, as programs that read tables want them. Never writes a value into a gap.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/api/history_json.hpp"

namespace axisgate::web {

struct CsvSigns {
  char separator = ',';
  char decimal = '.';  ///< another one than the separator
};

struct CsvRequest {
  std::vector<Series> series;
  std::vector<AxisInfoRecord> axes;  ///< of each series, in their order
  std::vector<EventRecord> events;
  Span span{};
  CsvSigns signs{};
};

class HistoryCsv {
 public:
  /// A piece ends where it has become longer.
  static constexpr std::size_t kPiece = 32 * 1024;

  /// @param each is asked again for each piece
  HistoryCsv(CsvRequest request, EachPoint each, const Now& now);

  /// What comes next, never much longer than kPiece; empty: that was all.
  [[nodiscard]] std::string next();

 private:
  /// Points of a series that are read and not written.
  struct Column {
    std::deque<Point> points;
    SteadyNs read = 0;  ///< up to here
    bool all_read = false;
    std::string cell;  ///< what holds
  };
  void read(std::size_t column);
  [[nodiscard]] std::optional<SteadyNs> next_instant();
  void add_row(std::string& out, SteadyNs at);
  [[nodiscard]] std::string number(std::size_t column, std::int64_t value) const;
  [[nodiscard]] std::string event_cell(const EventRecord& event) const;

  CsvRequest request_;
  EachPoint each_;
  Now now_;
  std::vector<Column> columns_;
  std::size_t event_ = 0;  ///< the next one
  bool head_ = false;      ///< it is written
  SteadyNs written_ = 0;   ///< the newest row
};

}  // namespace axisgate::web
