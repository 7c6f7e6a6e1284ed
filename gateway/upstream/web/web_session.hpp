// SPDX-License-Identifier: Apache-2.0
// The web session of the gateway: what axisgate-web is sent of the image, of events and of the gateway itself.
// Promises that of an axis the newest wins where the process is slow and that what was left out for it is counted; that
// each axis is sent each kAxisPeriod at least; and that what it costs does not depend on who looks at a page. Pure:
// instants go in, records come out. Never asks a drive anything, and never takes anything from the process.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/feed/axis_feed.hpp"
#include "gateway/upstream/feed/event_feed.hpp"
#include "gateway/upstream/web/axis_records.hpp"
#include "gateway/upstream/web/statistics_record.hpp"
#include "gateway/upstream/web/web_facts.hpp"
#include "gateway/upstream/web/web_settings.hpp"

namespace axisgate::web {

inline constexpr Duration kStatisticsPeriod = std::chrono::seconds(1);
/// An axis of which nothing is new goes out this often: how old its values are is known so well.
inline constexpr Duration kAxisPeriod = std::chrono::milliseconds(250);

/// This start of the gateway.
struct Boot {
  std::string version{};
  std::uint64_t number = 0;  ///< another one for each start
  Instant at = kLongAgo;
};

class WebSession {
 public:
  /// A mark of image.changes calls `wake`, which arms a timer and no more. `figures` is asked once a second.
  /// Everything passed by reference must outlive the session.
  WebSession(Boot boot, ProcessImage& image, const EventRing& events, std::function<ProcessFigures()> figures,
             std::function<void()> wake);

  /// The configuration, or another one: axes, buses and what is known of them begin from scratch.
  void take(const WebSettings& settings, WebFacts facts, Instant now);

  /// axisgate-web is there and knows nothing yet.
  void on_link_up(Instant now);
  void on_link_down() { link_up_ = false; }
  /// The socket did not take the record that next() gave last, and keeps it until it does.
  void on_no_room() { held_up_ = true; }

  /// What is to be sent now: what is fixed before events before samples before statistics. None: nothing before
  /// wake_at(), or the next wake(). The record counts as sent.
  [[nodiscard]] std::optional<Record> next(Instant now);
  [[nodiscard]] Instant wake_at() const;
  /// Samples of axes that were not sent in their time, since the socket had no room.
  [[nodiscard]] std::uint32_t gaps() const { return gaps_; }

 private:
  struct Known {
    AxisFacts facts;
    AxisInfoRecord info;  ///< as it was sent
    SentValues values;
    std::optional<AxisCountsRow> counts{};  ///< as they were sent
  };
  void begin(Instant now);
  [[nodiscard]] HelloRecord hello() const;
  [[nodiscard]] std::optional<Record> next_sample(Instant now);
  [[nodiscard]] SamplesRecord samples(Instant now);
  [[nodiscard]] Record statistics(Instant now);
  void look_for_other_info();
  void queue_counts(Instant now);

  const Boot boot_;
  WebSettings settings_;
  WebFacts facts_;
  ProcessImage& image_;
  const EventRing& ring_;
  std::function<ProcessFigures()> figures_;
  feed::EventFeed events_;
  feed::AxisFeed axes_;
  ChangeBoard::Reader changes_;
  std::map<AxisNumber, Known> known_;
  std::deque<Record> fixed_;  ///< what is fixed, and counts, on their way: bounded by the configuration
  Instant samples_due_ = kLongAgo;
  Instant statistics_due_ = kLongAgo;
  std::uint32_t gaps_ = 0;
  bool held_up_ = false;
  bool link_up_ = false;
};

}  // namespace axisgate::web
