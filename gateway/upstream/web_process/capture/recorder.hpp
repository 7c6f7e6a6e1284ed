// SPDX-License-Identifier: Apache-2.0
// Makes captures: when one begins, what of it is copied when, and which of them stay. Pure: records and instants in.
// Promises that of what the history held at a cause nothing is lost, that a cause which flickers makes one capture,
// that the newest stay, and bounds on how many are under way and on the bytes of all of them together. Never touches a
// file: whoever calls it writes and removes what it says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "gateway/upstream/web_process/capture/capture.hpp"
#include "gateway/upstream/web_process/capture/capture_settings.hpp"

namespace axisgate::web {

/// Of all captures together, where nobody says otherwise.
inline constexpr std::size_t kCaptureBytes = std::size_t{16} << 20;
/// Under way at once; a cause of one more axis is listed in the one that began last, where its axis is as well.
inline constexpr std::size_t kMostRunning = 4;
/// A cause that comes again sooner than this, or than `before_s`, belongs to the capture it has begun: what was before
/// it is there already.
inline constexpr SteadyNs kQuiet = 10 * kSecond;
/// Each further cause makes a capture longer, until so long behind the first one; a later one begins its own.
inline constexpr SteadyNs kLongest = 60 * kSecond;
/// What has happened reaches us so much later at most.
inline constexpr SteadyNs kBehind = 500 * kMillisecond;
/// Begins and ends that streams have not sent yet.
inline constexpr std::size_t kMostChanges = 64;

class Recorder {
 public:
  using Kept = std::shared_ptr<const Capture>;
  struct Change {
    std::uint64_t number = 0;
    Kept capture;
    bool complete = false;
  };
  /// What became of the captures: to be written, and then to be removed.
  struct Turn {
    std::vector<Kept> completed;
    std::vector<std::string> gone;
  };

  /// @param bytes of all captures together
  Recorder(CaptureSettings settings, std::size_t bytes)
      : settings_(std::move(settings)), causes_(settings_.triggers), bytes_(bytes) {}

  /// One of an earlier time of the computer.
  void restore(Capture capture);

  /// Another hello, before the picture and the history take it: what is under way ends here.
  void begin(const History& history, const Now& now);
  /// When the picture and the history have it.
  void take(const SamplesRecord& record, Picture& picture, const History& history, const Now& now);
  void take(const EventRecord& record, Picture& picture, const History& history, const Now& now);
  /// Several times a second. What became of captures since the last one.
  [[nodiscard]] Turn turn(Picture& picture, const History& history, const Now& now);

  /// Null: there is none of this id, or none any more.
  [[nodiscard]] Kept find(std::string_view id) const { return find_any(id); }
  /// Newest first, at first those that are under way.
  [[nodiscard]] std::vector<Kept> all() const;
  [[nodiscard]] const std::deque<Change>& changes() const { return changes_; }
  [[nodiscard]] std::uint64_t newest_change() const { return changed_; }
  [[nodiscard]] const CaptureSettings& settings() const { return settings_; }

 private:
  struct Running {
    std::shared_ptr<Capture> capture;
    SteadyNs copied = 0;  ///< until then
  };
  struct Again {
    SteadyNs at = 0;
    std::string id;
  };
  /// Axis, cause, name of a trigger.
  using Key = std::tuple<std::uint16_t, Cause, std::string>;

  void on(const CauseSeen& seen, const Picture& picture, const History& history, const Now& now);
  void begin_capture(const CauseSeen& seen, const Picture& picture, const History& history, const Now& now);
  [[nodiscard]] Running* running_with(const CauseSeen& seen);
  void copy(Running& running, SteadyNs until, const History& history) const;
  void finish(const std::shared_ptr<Capture>& capture);
  void make_room();
  [[nodiscard]] std::shared_ptr<Capture> find_any(std::string_view id) const;
  void note_change(Kept capture, bool complete);
  [[nodiscard]] std::string of_fault(std::uint16_t axis, const Picture& picture) const;

  const CaptureSettings settings_;
  Causes causes_;
  const std::size_t bytes_;
  std::vector<Running> running_;
  std::deque<std::shared_ptr<Capture>> kept_;  ///< oldest first
  std::map<Key, Again> last_;
  Turn done_;
  std::deque<Change> changes_;
  std::uint64_t changed_ = 0;
  std::uint64_t number_ = 0;  ///< of the newest id
};

}  // namespace axisgate::web
