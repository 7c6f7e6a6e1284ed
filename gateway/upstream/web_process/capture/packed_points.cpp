// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/packed_points.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace axisgate::web {
namespace {

constexpr unsigned kBitsOfAByte = 7;
constexpr std::uint64_t kMore = 0x80;
/// Beyond it an instant cannot be counted in ns.
constexpr std::uint64_t kMostUs = std::numeric_limits<std::int64_t>::max() / kMicrosecond;

void put_number(std::string& to, std::uint64_t number) {
  for (; number >= kMore; number >>= kBitsOfAByte) to.push_back(static_cast<char>(number | kMore));
  to.push_back(static_cast<char>(number));
}

std::optional<std::uint64_t> take_number(std::string_view& from) {
  constexpr unsigned kBits = 64;
  std::uint64_t number = 0;
  for (unsigned shift = 0; shift < kBits; shift += kBitsOfAByte) {
    if (from.empty()) return std::nullopt;
    const auto byte = static_cast<unsigned char>(from.front());
    from.remove_prefix(1);
    number |= (byte & (kMore - 1)) << shift;
    if (byte < kMore) return number;
  }
  return std::nullopt;
}

/// Small numbers for small differences, whatever their sign.
std::uint64_t folded(std::uint64_t difference) { return difference << 1 ^ (difference >> 63U != 0 ? ~0ULL : 0); }
std::uint64_t unfolded(std::uint64_t number) { return number >> 1 ^ ((number & 1U) != 0 ? ~0ULL : 0); }

bool same(const Point& one, const Point& other) {
  return one.known == other.known && (!one.known || one.value == other.value);
}

}  // namespace

void PackedPoints::put(std::string& to, Base& base, const Point& point) {
  const auto at_us = static_cast<std::uint64_t>(point.at / kMicrosecond);
  put_number(to, (at_us - base.at_us) << 1 | (point.known ? 1U : 0U));
  base.at_us = at_us;
  if (!point.known) return;
  put_number(to, folded(static_cast<std::uint64_t>(point.value) - base.value));
  base.value = static_cast<std::uint64_t>(point.value);
}

bool PackedPoints::take(std::string_view bytes, const Visit& visit) {
  Base base;
  while (!bytes.empty()) {
    const auto step = take_number(bytes);
    if (!step || *step >> 1 > kMostUs - base.at_us) return false;
    base.at_us += *step >> 1;
    Point point{static_cast<SteadyNs>(base.at_us) * kMicrosecond, 0, (*step & 1U) != 0};
    if (point.known) {
      const auto difference = take_number(bytes);
      if (!difference) return false;
      base.value += unfolded(*difference);
      point.value = static_cast<std::int64_t>(base.value);
    }
    if (!visit(point)) break;
  }
  return true;
}

std::optional<PackedPoints> PackedPoints::unpacked(std::string_view bytes, SteadyNs from, SteadyNs to) {
  PackedPoints out;
  bool within = true;
  const bool whole = take(bytes, [&](const Point& point) {
    within = within && point.at + kMicrosecond > from && point.at <= to;
    out.add(point);
    return within;
  });
  if (!whole || !within) return std::nullopt;
  return out;
}

void PackedPoints::add(Point point) {
  point.at -= point.at % kMicrosecond;
  if (!last_) {
    last_ = point;
    return;
  }
  if (point.at <= last_->at) return;
  if (same(point, *last_)) {
    if (!point.known) return;
    if (written_ != 0 && same(before_, *last_)) {
      last_->at = point.at;
      return;
    }
  }
  put(bytes_, base_, *last_);
  ++written_;
  before_ = *last_;
  last_ = point;
}

std::string PackedPoints::packed() const {
  std::string out = bytes_;
  Base base = base_;
  if (last_) put(out, base, *last_);
  return out;
}

void PackedPoints::each(SteadyNs from, SteadyNs to, const Visit& visit) const {
  std::optional<Point> held;
  const auto show_held = [&] {
    const auto shown = std::exchange(held, std::nullopt);
    return !shown || visit({from, shown->value, shown->known});
  };
  bool more = true;
  const Visit look = [&](const Point& point) {
    if (point.at <= from)
      held = point;
    else
      more = point.at <= to && show_held() && visit(point);
    return more;
  };
  take(bytes_, look);
  if (more && last_) more = look(*last_);
  if (held) show_held();
}

void Thinned::add(const Point& point) {
  if (!point.known) {
    flush();
    to_.add(point);
    return;
  }
  if (point.at / kSlice != slice_) flush();
  slice_ = point.at / kSlice;
  if (!any_ || point.value < low_.value) low_ = point;
  if (!any_ || point.value > high_.value) high_ = point;
  last_ = point;
  any_ = true;
}

void Thinned::flush() {
  if (!any_) return;
  any_ = false;
  const bool low_first = low_.at < high_.at;
  to_.add(low_first ? low_ : high_);
  to_.add(low_first ? high_ : low_);
  to_.add(last_);
}

}  // namespace axisgate::web
