// SPDX-License-Identifier: Apache-2.0
// The line in which a command that moves an axis shows where it is: written over on a terminal, elsewhere a line now
// and then. Promises never to wait for a terminal that takes nothing (a signal of life must not), and to tell when
// nobody can read it any more. Never decides what is shown.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "gateway/core/clock.hpp"

namespace axisgate::commands {

class ManualScreen {
 public:
  static constexpr Duration kElsewhere = std::chrono::seconds(1);

  explicit ManualScreen(std::function<void()> on_gone);
  /// `doing`: elsewhere than on a terminal a new one is shown at once.
  void show(std::string_view line, std::string_view doing, Instant now);
  /// The line that was written over goes.
  void clear();
  /// A line that stays.
  void say(std::string_view line);

 private:
  void put(std::string_view text);

  std::function<void()> on_gone_;
  bool terminal_;
  bool gone_ = false;
  bool on_line_ = false;
  std::string last_doing_;
  Instant next_ = kLongAgo;
};

}  // namespace axisgate::commands
