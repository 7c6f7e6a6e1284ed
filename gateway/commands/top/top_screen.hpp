// SPDX-License-Identifier: Apache-2.0
// Where `axisgate top` writes: a terminal that is redrawn in place, or plain lines for pipes and logs.
// Promises to leave the terminal as it was found, however the command ends.
// Never decides what is shown.
#pragma once

#include <boost/noncopyable.hpp>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gateway/commands/view/top_table.hpp"

namespace axisgate::commands {

/// One frame of a redrawn terminal: `lines` cut to the window and what was there before wiped. Pure. `colours`: what
/// asks for attention is yellow or red.
[[nodiscard]] std::string terminal_frame(std::span<const TopLine> lines, std::size_t columns, std::size_t rows,
                                         bool colours = false);

class TopScreen : boost::noncopyable {
 public:
  explicit TopScreen(bool plain);
  ~TopScreen();

  /// Of the window; 0: lines may be as long as they like.
  [[nodiscard]] std::size_t columns() const;
  /// A terminal is redrawn in place: what stands below the table stays there.
  [[nodiscard]] bool redraws() const { return redraws_; }
  [[nodiscard]] bool colours() const { return colours_; }
  void show_table(const std::vector<TopLine>& table);
  /// On a terminal above the last table; in plain output only when it changes, so that a log is not filled with it.
  void show_message(const std::string& message);

 private:
  void draw(std::span<const TopLine> lines);

  bool redraws_;
  bool colours_;
  std::vector<TopLine> last_table_;
  std::string last_message_;
};

}  // namespace axisgate::commands
