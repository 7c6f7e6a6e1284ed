// SPDX-License-Identifier: Apache-2.0
// Which objects of a drive are asked in vain, and when each is asked again (design 7, Mute objects). Pure: instants go
// in. Promises that an object is given up after kTries tries in a row and then asked ever more seldom, one without
// which there is no axis each kLongestNeeded at the latest; and that any object which answers again has all of them
// asked at once. Never judges whether the drive is there: whoever counts a try here knows that it answers others.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

class ObjectTries {
 public:
  static constexpr int kTries = 3;
  /// Between the tries of what is refused: a drive that is busy for a moment loses nothing.
  static constexpr Duration kRefusedPause = std::chrono::milliseconds(250);
  static constexpr Duration kFirstPause = std::chrono::milliseconds(500);
  static constexpr Duration kLongestPause = std::chrono::seconds(60);
  static constexpr Duration kLongestNeeded = std::chrono::seconds(2);

  /// What came of a try: the drive's code where it refused; none: no answer.
  using Refusal = std::optional<std::uint32_t>;

  explicit ObjectTries(std::size_t objects) : entries_(objects) {}

  /// The drive comes up from scratch: each object has its tries again. What was reported of it is not reported again.
  void restart();
  /// It stays given up, through a restart() that is none of the drive's.
  void keep_given_up(model::ObjectId object, Instant now);
  /// `needed`: without it there is no axis. True: it is given up with this try, or was before.
  [[nodiscard]] bool in_vain(model::ObjectId object, const Refusal& refusal, bool needed, Instant now);
  /// It was read. True: it had been given up, and all others that are may be asked now.
  [[nodiscard]] bool answered(model::ObjectId object);
  [[nodiscard]] bool given_up(model::ObjectId object) const { return entries_[object].tries >= kTries; }
  /// Not to be asked before; kLongAgo: whenever it is due.
  [[nodiscard]] Instant again(model::ObjectId object) const { return entries_[object].again; }
  [[nodiscard]] const Refusal& refusal(model::ObjectId object) const { return entries_[object].refusal; }
  struct GivenUp {
    model::ObjectId object = model::kNoObject;
    bool first_report = false;  ///< for the first time since it answered last
  };
  /// Since the last call, each once.
  [[nodiscard]] std::vector<GivenUp> take_given_up();

 private:
  struct Entry {
    int tries = 0;  ///< in a row, kTries at most
    Duration pause{};
    Instant again = kLongAgo;
    Refusal refusal{};
    bool reported = false;
  };
  std::vector<Entry> entries_;
  std::vector<GivenUp> given_up_;  ///< each object once
};

/// What the profile has this object for, in words: "dc_voltage", "the state of axis 1".
[[nodiscard]] std::string uses_of(const model::DriveModel& model, model::ObjectId object);

}  // namespace axisgate::drive
