// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/picture/picture.hpp"

#include <bit>
#include <cstdlib>
#include <type_traits>

#include "gateway/upstream/web_process/values/series.hpp"

namespace axisgate::web {
namespace {

constexpr SteadyNs kResultTremble = 5 * kMillisecond;
/// A profile's table has some hundred rows, and there are some dozen profiles: a bound beyond all of them.
constexpr std::size_t kMostFaultWords = 16384;

}  // namespace

bool AxisPicture::latched_and_stands() const {
  constexpr std::int64_t kTremble = 1000;  // 0.001 rpm
  if (!has(AxisAlarm::stop_latched)) return false;
  const std::uint32_t velocity = bit(Quantity::velocity_actual);
  if ((sample.supported & velocity) == 0) return true;
  const HeldValue& held = of(Quantity::velocity_actual);
  return (sample.valid & velocity) != 0 && held.known && held.value > -kTremble && held.value < kTremble;
}

bool Picture::take(const Record& record, SteadyNs now) {
  heard_ = now;
  return std::visit(
      [this](const auto& each) {
        using R = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<R, ReadyRecord> || std::is_same_v<R, LogRecord>) {
          return false;
        } else {
          on(each);
          return true;
        }
      },
      record);
}

bool Picture::complete() const {
  return generation_ != 0 && axes_.size() >= hello_.axes && buses_.size() >= hello_.buses;
}

const AxisPicture* Picture::find(std::uint16_t axis) const {
  const auto found = axes_.find(axis);
  return found == axes_.end() ? nullptr : &found->second;
}

void Picture::on(const HelloRecord& record) {
  if (record.boot != hello_.boot) events_.clear();
  hello_ = record;
  ++generation_;
  axes_.clear();
  buses_.clear();
  fault_words_.clear();
  statistics_ = {};
}

void Picture::on(const AxisInfoRecord& record) {
  if (record.axis != 0 && record.axis <= kMaxAxisNumber) axes_[record.axis].info = record;
}

void Picture::on(const FaultWordRecord& record) {
  if (fault_words_.size() < kMostFaultWords) fault_words_.push_back(record);
}

void Picture::on(const SamplesRecord& record) {
  gaps_ = record.gaps;
  for (const AxisSample& sample : record.axes)
    if (const auto found = axes_.find(sample.axis); found != axes_.end()) take_sample(found->second, sample, record.at);
}

void Picture::take_sample(AxisPicture& axis, const AxisSample& sample, SteadyNs at) {
  for (const Value& value : sample.values)
    if (value.quantity < kQuantityCount)
      axis.values[value.quantity] = {true, series_number(value.quantity, std::bit_cast<std::uint32_t>(value.value)),
                                     at - value.age_us * kMicrosecond};
  // Its age comes in whole milliseconds: of one and the same result it must not go to and fro.
  const SteadyNs result = at - sample.result_age_ms * SteadyNs{kMillisecond};
  if (std::abs(result - axis.result) > kResultTremble) axis.result = result;
  axis.sample = sample;
  axis.sample.values.clear();
  axis.sampled = at;
  ++axis.revision;
  const bool fault =
      axis.has(AxisInput::fault) || sample.axis_state == static_cast<std::uint8_t>(AxisState::error_stop);
  if (!fault) {
    axis.fault = 0;
    axis.capture.clear();
  }
  if (fault && axis.fault == 0) axis.fault = at;
}

void Picture::captured(std::uint16_t axis, std::string id) {
  const auto found = axes_.find(axis);
  if (found == axes_.end()) return;
  found->second.capture = std::move(id);
  ++found->second.revision;
}

void Picture::forget_capture(const std::string& id) {
  for (auto& [number, axis] : axes_)
    if (axis.capture == id) captured(number, {});
}

void Picture::on(const EventRecord& record) {
  if (record.number <= newest_event()) return;
  events_.push_back(record);
  if (events_.size() > kMostEvents) events_.pop_front();
}

void Picture::on(const StatisticsRecord& record) {
  statistics_ = record;
  for (auto& [place, bus] : buses_) {
    if (place >= record.buses.size()) continue;
    bus.newest = record.buses[place];
  }
}

void Picture::on(const CountsRecord& record) {
  for (const BusCounts& counts : record.buses) {
    const auto found = buses_.find(counts.bus);
    if (found == buses_.end()) continue;
    found->second.counts = counts;
    found->second.times.add(counts.times, record.at);
  }
  for (const AxisCountsRow& counts : record.axes)
    if (const auto found = axes_.find(counts.axis); found != axes_.end()) found->second.counts = counts;
}

}  // namespace axisgate::web
