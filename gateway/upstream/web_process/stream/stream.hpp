// SPDX-License-Identifier: Apache-2.0
// One page's stream: which frame of server-sent events goes next. Pure: the feed and instants in.
// Promises that a frame is made when it can be sent, from what is newest then: so a slow page gets fewer frames, never
// older ones, and nothing piles up for it. Never leaves an event out that is still in the ring.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "gateway/upstream/web_process/api/router.hpp"
#include "gateway/upstream/web_process/stream/feed.hpp"
#include "gateway/upstream/web_process/stream/scope.hpp"

namespace axisgate::web {

/// A frame ends where it has become longer; the next axes come in the next frame.
inline constexpr std::size_t kFrame = 60 * 1024;
/// All streams have their turns on one grid, so that the feed is made once for all of them.
inline constexpr SteadyNs kGrid = 50 * kMillisecond;
inline constexpr SteadyNs kSaysSomethingEach = kSecond;

class Stream {
 public:
  Stream(StreamRequest request, const Picture& picture, SteadyNs now);

  /// What to send now; empty: nothing is due. Again as soon as that is sent.
  [[nodiscard]] std::string next(const Stores& stores, const Feed& feed, const Now& now);
  /// The last frame.
  [[nodiscard]] static std::string bye(std::string_view why);

 private:
  void begin(const Feed& feed, SteadyNs now);
  [[nodiscard]] std::string hello(const Picture& picture);
  [[nodiscard]] std::string events(const Picture& picture, const Now& now);
  [[nodiscard]] std::string captures(const Recorder& recorder);
  [[nodiscard]] std::string axes(const Feed& feed, const Now& now);
  [[nodiscard]] std::string whole(std::string_view event, const WholeObject& object, Version& sent, const Now& now);
  [[nodiscard]] std::string scope(const Stores& stores, const Now& now);
  [[nodiscard]] SteadyNs period() const { return static_cast<SteadyNs>(request_.period_ms) * kMillisecond; }
  [[nodiscard]] SteadyNs turn_after(SteadyNs now) const;

  const StreamRequest request_;
  std::uint64_t generation_ = 0;           ///< of what was sent; 0: not even hello
  std::uint64_t event_ = 0;                ///< the newest that was sent
  std::optional<std::uint64_t> capture_;   ///< the newest change of captures; none: no stream before
  std::map<std::uint16_t, Version> sent_;  ///< by axis, what it was last
  std::uint16_t reached_ = 0;              ///< of this turn, the axis that was looked at last
  bool first_ = true;                      ///< no axes were sent since hello
  bool was_joined_ = false;
  SteadyNs axes_due_ = 0;
  Scope scope_;
  SteadyNs scope_due_ = 0;
  SteadyNs whole_due_ = 0;
  Version buses_ = 0;
  Version gateway_ = 0;
  SteadyNs said_ = 0;
};

}  // namespace axisgate::web
