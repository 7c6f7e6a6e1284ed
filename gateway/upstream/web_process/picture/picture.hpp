// SPDX-License-Identifier: Apache-2.0
// The newest of everything: what the gateway has reported of itself, its buses, axes and events. Pure: records and
// instants in. Promises that nothing is shown as good that was last reported kJoinedFor ago, and that a new `hello`
// makes all that was there before void. Never asks the gateway for anything.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/image/axis_image.hpp"
#include "gateway/image/quantity.hpp"
#include "gateway/upstream/web_link/records.hpp"
#include "gateway/upstream/web_process/picture/exchange_times.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

/// Silence of the gateway for longer: it is not joined.
inline constexpr SteadyNs kJoinedFor = 2 * kSecond;
/// It tells its statistics once a second: its loop stands where it has sent none for so long.
inline constexpr SteadyNs kAliveFor = 3 * kSecond;
inline constexpr std::size_t kMostEvents = 1000;

/// One value, with when it was right.
struct HeldValue {
  bool known = false;
  std::int64_t value = 0;  ///< register units
  SteadyNs at = 0;
};

struct AxisPicture {
  AxisInfoRecord info{};
  AxisSample sample{};         ///< the newest; its values are in `values`
  SteadyNs sampled = 0;        ///< when the sample was made; 0: none came yet
  SteadyNs fault = 0;          ///< since when there is a fault; 0: there is none
  std::string capture{};       ///< of the fault there is; empty: none
  SteadyNs result = 0;         ///< when the newest result came
  std::uint64_t revision = 0;  ///< another one after each sample
  std::array<HeldValue, kQuantityCount> values{};
  std::optional<AxisCountsRow> counts{};

  [[nodiscard]] const HeldValue& of(Quantity quantity) const { return values[static_cast<std::size_t>(quantity)]; }
  [[nodiscard]] bool has(AxisInput input) const { return (sample.inputs & bit(input)) != 0; }
  [[nodiscard]] bool has(AxisAlarm alarm) const { return (sample.alarms & bit(alarm)) != 0; }
  /// A stop is latched, and nothing shows that it turns.
  [[nodiscard]] bool latched_and_stands() const;
};

struct BusPicture {
  BusInfoRecord info{};
  std::optional<BusStatistics> newest{};
  std::optional<BusCounts> counts{};
  ExchangeTimes times{};
};

class Picture {
 public:
  /// False: the gateway never sends such a record.
  [[nodiscard]] bool take(const Record& record, SteadyNs now);
  /// In which capture the fault of this axis is; empty: in none.
  void captured(std::uint16_t axis, std::string id);
  /// It is there no more.
  void forget_capture(const std::string& id);
  /// The gateway's socket is closed.
  void close() { open_ = false; }

  /// All that the newest hello has announced is here.
  [[nodiscard]] bool complete() const;
  [[nodiscard]] bool joined(SteadyNs now) const { return open_ && complete() && now - heard_ <= kJoinedFor; }
  [[nodiscard]] bool alive(SteadyNs now) const {
    return joined(now) && statistics_.at != 0 && now - statistics_.at <= kAliveFor;
  }
  /// When something came last; 0: never.
  [[nodiscard]] SteadyNs heard() const { return heard_; }

  /// Another one for each hello.
  [[nodiscard]] std::uint64_t generation() const { return generation_; }
  [[nodiscard]] const HelloRecord& hello() const { return hello_; }
  /// By number.
  [[nodiscard]] const std::map<std::uint16_t, AxisPicture>& axes() const { return axes_; }
  [[nodiscard]] const AxisPicture* find(std::uint16_t axis) const;
  /// By place in the configuration.
  [[nodiscard]] const std::map<std::uint8_t, BusPicture>& buses() const { return buses_; }
  [[nodiscard]] const std::vector<FaultWordRecord>& fault_words() const { return fault_words_; }
  /// `at` is 0 before the first.
  [[nodiscard]] const StatisticsRecord& statistics() const { return statistics_; }
  [[nodiscard]] std::uint32_t gaps() const { return gaps_; }
  /// The newest last; numbers rise.
  [[nodiscard]] const std::deque<EventRecord>& events() const { return events_; }
  /// Number of the newest event; 0: there is none.
  [[nodiscard]] std::uint64_t newest_event() const { return events_.empty() ? 0 : events_.back().number; }

 private:
  void on(const HelloRecord& record);
  void on(const AxisInfoRecord& record);
  void on(const BusInfoRecord& record) { buses_[record.bus].info = record; }
  void on(const FaultWordRecord& record);
  void on(const SamplesRecord& record);
  void on(const EventRecord& record);
  void on(const StatisticsRecord& record);
  void on(const CountsRecord& record);
  static void take_sample(AxisPicture& axis, const AxisSample& sample, SteadyNs at);

  bool open_ = true;
  SteadyNs heard_ = 0;
  std::uint64_t generation_ = 0;
  HelloRecord hello_{};
  std::map<std::uint16_t, AxisPicture> axes_;
  std::map<std::uint8_t, BusPicture> buses_;
  std::vector<FaultWordRecord> fault_words_;
  StatisticsRecord statistics_{};
  std::uint32_t gaps_ = 0;
  std::deque<EventRecord> events_;
};

}  // namespace axisgate::web
