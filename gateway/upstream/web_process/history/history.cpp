// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/history/history.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

namespace axisgate::web {
namespace {

constexpr std::int64_t kSilentAfterUs = kSilentAfter / kMicrosecond;

constexpr std::uint64_t bit_of(std::uint8_t name) { return std::uint64_t{1} << name; }

bool is_same_axis(const AxisInfoRecord& a, const AxisInfoRecord& b) {
  return a.name == b.name && a.bus == b.bus && a.node == b.node && a.drive == b.drive &&
         a.units_numerator == b.units_numerator && a.units_denominator == b.units_denominator;
}

std::array<std::pair<StateSeries, std::uint32_t>, kSeriesNames - kQuantityCount> states_of(const AxisSample& sample) {
  return {{{StateSeries::axis_state, sample.axis_state},
           {StateSeries::motion_state, sample.motion_state},
           {StateSeries::link_state, sample.link_state},
           {StateSeries::alarms, sample.alarms}}};
}

}  // namespace

void History::take(const HelloRecord& record) {
  if (record.boot == boot_) return;
  boot_ = record.boot;
  gaps_ = 0;
  for (auto& [number, axis] : axes_) forget(axis);
  axes_.clear();
  oldest_us_ = newest_us_ = 0;
}

void History::take(const AxisInfoRecord& record) {
  if (record.axis == 0 || record.axis > kMaxAxisNumber) return;
  const auto [found, is_new] = axes_.try_emplace(record.axis);
  if (!is_new && !is_same_axis(found->second.info, record)) forget(found->second);
  found->second.info = record;
}

void History::forget(Axis& axis) {
  for (const Line& line : axis.lines)
    for (const ChunkPool::Place place : line.chunks) pool_.give_back(place);
  axis = {};
}

void History::take(const SamplesRecord& record) {
  if (record.gaps != gaps_)
    for (auto& [number, axis] : axes_) axis.lost = true;
  gaps_ = record.gaps;
  newest_us_ = record.at / kMicrosecond;
  if (oldest_us_ == 0) oldest_us_ = newest_us_;
  for (const AxisSample& sample : record.axes)
    if (const auto found = axes_.find(sample.axis); found != axes_.end()) take(found->second, sample, newest_us_);
}

void History::take(Axis& axis, const AxisSample& sample, Us at) {
  if (axis.heard != 0 && at - axis.heard > kSilentAfterUs) begin_gaps(axis, sample.axis, axis.known, axis.heard + 1);
  axis.heard = at;
  const std::uint64_t valid = sample.valid & sample.supported;
  std::uint64_t seen = 0;
  const auto take_value = [&](std::uint8_t name, Us right, std::uint32_t bits) {
    const Series series{sample.axis, name};
    if (axis.lost) begin_gap(axis, series, axis.lines[name].at + 1);
    note(axis, series, right, bits, at);
    seen |= bit_of(name);
  };
  for (const Value& value : sample.values)
    if (value.quantity < kQuantityCount && (valid & bit_of(value.quantity)) != 0)
      take_value(value.quantity, at - value.age_us, std::bit_cast<std::uint32_t>(value.value));
  for (const auto& [state, number] : states_of(sample)) take_value(static_cast<std::uint8_t>(state), at, number);
  axis.lost = false;
  begin_gaps(axis, sample.axis, axis.known & ~valid & ~seen, at);
  // Valid again without another sample: it is what it was.
  for (std::uint64_t back = axis.ever & ~axis.known & valid; back != 0; back &= back - 1) {
    const auto name = static_cast<std::uint8_t>(std::countr_zero(back));
    note(axis, {sample.axis, name}, at, axis.lines[name].bits, at);
  }
}

/// @param made when the record was: a value of before a gap that comes again holds from then on
void History::note(Axis& axis, Series series, Us at, std::uint32_t bits, Us made) {
  ++samples_;
  Line& line = axis.lines[series.name];
  const bool known = (axis.known & bit_of(series.name)) != 0;
  if (known && at <= line.at && bits == line.bits) return;
  if (at <= line.at) at = known ? line.at + 1 : std::max(made, line.at + 1);
  axis.ever |= bit_of(series.name);
  axis.known |= bit_of(series.name);
  if (known && bits == line.bits && !line.chunks.empty()) {
    Chunk& chunk = pool_[line.chunks.back()];
    Run& run = chunk.newest();
    if (const Us length = at - chunk.begin_of(run); length <= Run::kLongest) {
      run.length = static_cast<std::uint32_t>(length) & Run::kLongest;
      pool_.written(line.chunks.back());
      line.at = at;
      return;
    }
  }
  add_run(line, series, at, bits, true);
  line.bits = bits;
}

void History::begin_gap(Axis& axis, Series series, Us at) {
  if ((axis.known & bit_of(series.name)) == 0) return;
  axis.known &= ~bit_of(series.name);
  Line& line = axis.lines[series.name];
  add_run(line, series, std::max(at, line.at + 1), 0, false);
}

void History::begin_gaps(Axis& axis, std::uint16_t number, std::uint64_t names, Us at) {
  for (; names != 0; names &= names - 1)
    begin_gap(axis, {number, static_cast<std::uint8_t>(std::countr_zero(names))}, at);
}

void History::add_run(Line& line, Series series, Us at, std::uint32_t bits, bool known) {
  const auto fits = [at](const Chunk& chunk) {
    return chunk.count < Chunk::kRuns && at - chunk.begin <= std::numeric_limits<std::uint32_t>::max();
  };
  if (line.chunks.empty() || !fits(pool_[line.chunks.back()])) {
    const ChunkPool::Place place = another_chunk(series, at);
    line.chunks.push_back(place);
  }
  Chunk& chunk = pool_[line.chunks.back()];
  Run& run = chunk.runs.at(chunk.count++);
  run = {static_cast<std::uint32_t>(at - chunk.begin), bits, 0, known ? 1U : 0U};
  line.at = at;
  pool_.written(line.chunks.back());
}

ChunkPool::Place History::another_chunk(Series series, Us begin) {
  if (const auto taken = pool_.next_taken()) {
    Chunk& chunk = pool_[*taken];
    oldest_us_ = std::max(oldest_us_, chunk.end_of(chunk.newest()) + 1);
    std::erase(axes_.at(chunk.owner.axis).lines[chunk.owner.name].chunks, *taken);
  }
  const ChunkPool::Place place = pool_.take(series);
  pool_[place].begin = begin;
  return place;
}

void History::each_run(const Line& line, Us from, const std::function<bool(const Chunk&, const Run&)>& visit) const {
  auto place = std::ranges::upper_bound(line.chunks, from, {}, [this](auto each) { return pool_[each].begin; });
  if (place != line.chunks.begin()) --place;
  for (; place != line.chunks.end(); ++place) {
    const Chunk& chunk = pool_[*place];
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const bool next_holds = i + 1U < chunk.count && chunk.begin_of(chunk.runs[i + 1]) <= from;
      if (!next_holds && !visit(chunk, chunk.runs[i])) return;
    }
  }
}

void History::each(Series series, SteadyNs from, SteadyNs to, const Visit& visit) const {
  const auto found = axes_.find(series.axis);
  if (found == axes_.end() || series.name >= kSeriesNames || (found->second.ever & bit_of(series.name)) == 0) return;
  const Axis& axis = found->second;
  const Line& line = axis.lines[series.name];
  const auto point = [&](SteadyNs at, std::uint32_t bits, bool known) {
    return Point{at, known ? series_number(series.name, bits) : 0, known};
  };
  const SteadyNs silent = (axis.heard + 1) * kMicrosecond;
  const bool is_silent = to - silent >= kSilentAfter;
  if (is_silent && from >= silent) {
    visit({from, 0, false});
    return;
  }
  bool goes_on = true;
  const auto show = [&](const Point& shown) { goes_on = goes_on && visit(shown); };
  // Of a line whose runs were all thrown away, what it was last is still there.
  if (const SteadyNs at = std::max(from, line.at * kMicrosecond); line.chunks.empty() && at <= to)
    show(point(at, line.bits, (axis.known & bit_of(series.name)) != 0));
  each_run(line, from / kMicrosecond, [&](const Chunk& chunk, const Run& run) {
    const SteadyNs begin = std::max(from, chunk.begin_of(run) * kMicrosecond);
    const SteadyNs end = std::min(to, chunk.end_of(run) * kMicrosecond);
    if (begin > to) return false;
    show(point(begin, run.bits, run.known != 0));
    if (run.known != 0 && end > begin) show(point(end, run.bits, true));
    return goes_on;
  });
  if (is_silent && (axis.known & bit_of(series.name)) != 0) show({silent, 0, false});
}

}  // namespace axisgate::web
