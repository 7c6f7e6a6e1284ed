// SPDX-License-Identifier: Apache-2.0
// The points of one line of a capture, in a few bytes each: differences to the point before, a standing value once at
// its begin and once at its end. Promises instants to a microsecond, and that bytes from elsewhere are either points or
// refused. Never has two points of one instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/upstream/web_process/history/history.hpp"

namespace axisgate::web {

class PackedPoints {
 public:
  /// What packed() has made; none: it has not. @param from, to where all of them must be
  [[nodiscard]] static std::optional<PackedPoints> unpacked(std::string_view bytes, SteadyNs from, SteadyNs to);

  /// One that is not newer than the last one is left out.
  void add(Point point);
  /// As EachPoint says.
  void each(SteadyNs from, SteadyNs to, const Visit& visit) const;

  [[nodiscard]] std::string packed() const;
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }
  [[nodiscard]] std::size_t size() const { return written_ + (last_ ? 1 : 0); }

 private:
  struct Base {
    std::uint64_t at_us = 0;
    std::uint64_t value = 0;  ///< the newest that is known, as its bits
  };
  static void put(std::string& to, Base& base, const Point& point);
  /// False: they are not whole.
  static bool take(std::string_view bytes, const Visit& visit);

  std::string bytes_;  ///< all but the last
  Base base_;
  Point before_;  ///< the last in bytes_
  std::size_t written_ = 0;
  std::optional<Point> last_;
};

/// Of a line that has more points than it may: of each slice the lowest, the highest and the last, in the order of
/// time; so that no spike is lost, and what stands behind it is right.
class Thinned {
 public:
  static constexpr SteadyNs kSlice = 100 * kMillisecond;

  explicit Thinned(PackedPoints& to) : to_(to) {}

  void add(const Point& point);
  /// Behind the last one.
  void flush();

 private:
  PackedPoints& to_;
  SteadyNs slice_ = 0;
  bool any_ = false;
  Point low_, high_, last_;
};

}  // namespace axisgate::web
