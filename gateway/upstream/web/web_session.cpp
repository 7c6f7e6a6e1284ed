// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web/web_session.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::web {
namespace {

SteadyNs steady(Instant at) { return at == kLongAgo ? 0 : at.time_since_epoch().count(); }

EventRecord event_record(const Event& event) {
  return {event.number, steady(event.at), event.axis, static_cast<std::uint8_t>(event.kind), event.code, event.text};
}

}  // namespace

WebSession::WebSession(Boot boot, ProcessImage& image, const EventRing& events, std::function<ProcessFigures()> figures,
                       std::function<void()> wake)
    : boot_(std::move(boot)),
      image_(image),
      ring_(events),
      figures_(std::move(figures)),
      events_(events),
      axes_({}, kAxisPeriod),
      changes_(image.changes, [this, wake = std::move(wake)] {
        if (link_up_) wake();
      }) {}

void WebSession::take(const WebSettings& settings, WebFacts facts, Instant now) {
  settings_ = settings;
  facts_ = std::move(facts);
  if (link_up_) begin(now);
}

void WebSession::on_link_up(Instant now) {
  link_up_ = true;
  held_up_ = false;
  events_.restart();
  begin(now);
}

void WebSession::begin(Instant now) {
  known_.clear();
  axes_ = feed::AxisFeed({}, kAxisPeriod);
  fixed_.assign(1, hello());
  for (const AxisFacts& facts : facts_.axes) {
    const AxisImage* const axis = image_.find(facts.axis);
    if (axis == nullptr) continue;
    axes_.add(axis->number, now);
    fixed_.emplace_back(
        known_.insert_or_assign(axis->number, Known{facts, axis_info(*axis, facts), {}}).first->second.info);
  }
  for (const BusInfoRecord& bus : facts_.buses) fixed_.emplace_back(bus);
  for (const FaultWordRecord& word : facts_.fault_words) fixed_.emplace_back(word);
  samples_due_ = statistics_due_ = now;
}

HelloRecord WebSession::hello() const {
  const auto there =
      std::ranges::count_if(facts_.axes, [this](const AxisFacts& facts) { return image_.find(facts.axis) != nullptr; });
  return {settings_.gateway,
          boot_.version,
          boot_.number,
          steady(boot_.at),
          static_cast<std::uint16_t>(there),
          static_cast<std::uint16_t>(facts_.buses.size()),
          facts_.low_word_first,
          facts_.float_numbers};
}

std::optional<Record> WebSession::next(Instant now) {
  if (!link_up_) return std::nullopt;
  changes_.take_event();
  // Axes wait for the tick: each one taken before it would have the next one wake us once more.
  if (samples_due_ <= now) changes_.take([&](std::size_t axis) { axes_.changed(static_cast<AxisNumber>(axis), now); });
  if (!fixed_.empty()) {
    Record record = std::move(fixed_.front());
    fixed_.pop_front();
    return record;
  }
  if (const Event* const event = events_.next()) return event_record(*event);
  // Where the reader is so slow that samples are always due, these would never come.
  if (statistics_due_ + kStatisticsPeriod <= now) return statistics(now);
  if (auto record = next_sample(now)) return record;
  if (statistics_due_ <= now) return statistics(now);
  return std::nullopt;
}

/// What is due at one tick goes in as many packets as it takes; then nothing before the next one.
std::optional<Record> WebSession::next_sample(Instant now) {
  if (samples_due_ > now || axes_.due() > now) return std::nullopt;
  if (std::exchange(held_up_, false) && now - samples_due_ >= settings_.sample_period)
    gaps_ += static_cast<std::uint32_t>(axes_.waiting(now));
  SamplesRecord record = samples(now);
  if (axes_.due() > now) samples_due_ = now + settings_.sample_period;
  return record;
}

SamplesRecord WebSession::samples(Instant now) {
  SamplesRecord record;
  record.at = now.time_since_epoch().count();
  record.gaps = gaps_;
  // The largest that an axis can add still has room.
  constexpr std::size_t kHead = 32;
  constexpr std::size_t kLargest = 512 + 3 * kMaxName;
  std::size_t size = kHead;
  while (size + kLargest <= kMaxPacket) {
    const auto number = axes_.next(now);
    if (!number) break;
    const AxisImage* const axis = image_.find(*number);
    if (axis == nullptr) {
      axes_.remove(*number);  // a reload has begun: the facts follow
      continue;
    }
    record.axes.push_back(axis_sample(*axis, known_.at(*number).values, now));
    size += size_bound(record.axes.back());
  }
  return record;
}

Record WebSession::statistics(Instant now) {
  statistics_due_ = now + kStatisticsPeriod;
  look_for_other_info();
  Record record = statistics_record(image_, figures_(), {events_.lost(), ring_.added_by_kind()}, now);
  queue_counts(now);
  return record;
}

/// After the statistics, which have the image's rows of buses gathered.
void WebSession::queue_counts(Instant now) {
  CountsRecord record;
  record.at = now.time_since_epoch().count();
  std::size_t size = 0;
  // One that begins with half of this has room for the largest row.
  constexpr std::size_t kFull = kMaxPacket / 2;
  constexpr std::size_t kBus = sizeof(BusCounts), kAxis = sizeof(AxisCountsRow), kCommand = sizeof(CommandCount);
  const auto add = [&](auto& rows, auto row, std::size_t more) {
    rows.push_back(std::move(row));
    size += more;
    if (size < kFull) return;
    fixed_.emplace_back(record);
    record.buses.clear();
    record.axes.clear();
    size = 0;
  };
  for (std::size_t place = 0; place < image_.buses.size(); ++place)
    add(record.buses, bus_counts(image_.buses[place], place), kBus);
  for (auto& [number, known] : known_) {
    const AxisImage* const axis = image_.find(number);
    if (axis == nullptr) continue;
    AxisCountsRow row = axis_counts(*axis);
    if (known.counts == row) continue;
    known.counts = row;
    const std::size_t more = kAxis + kCommand * row.commands.size();
    add(record.axes, std::move(row), more);
  }
  if (size != 0) fixed_.emplace_back(std::move(record));
}

/// A drive may say, as it comes up, that its limits are others, or that it has less than its profile.
void WebSession::look_for_other_info() {
  for (auto& [number, known] : known_) {
    const AxisImage* const axis = image_.find(number);
    if (axis == nullptr) continue;
    AxisInfoRecord info = axis_info(*axis, known.facts);
    if (info == known.info) continue;
    known.info = info;
    fixed_.emplace_back(std::move(info));
  }
}

Instant WebSession::wake_at() const {
  if (!link_up_) return kNever;
  if (!fixed_.empty() || events_.waiting()) return kLongAgo;
  return std::min(changes_.any() ? samples_due_ : std::max(samples_due_, axes_.due()), statistics_due_);
}

}  // namespace axisgate::web
