// SPDX-License-Identifier: Apache-2.0
// Lines that a person types, or that come from a pipe or file in their place, taken while the loop runs.
// Promises that the loop never waits for the person, and that what was typed on a terminal before a line is asked for
// does not count as it. Never changes the descriptor: O_NONBLOCK would be set for the shell that shares it as well.
// Never starts a thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace axisgate {

class LineInput {
 public:
  /// What is longer is no answer of a person: it ends the input.
  static constexpr std::size_t kLongestLine = 4096;
  /// Without its end of line; none: no line will come any more.
  using OnLine = std::function<void(std::optional<std::string>)>;

  /// `descriptor` is not closed. `context` outlives this.
  LineInput(boost::asio::io_context& context, int descriptor);
  /// Once for each call, from the loop; the next call comes after it.
  void next(OnLine on_line);

 private:
  enum class Read : std::uint8_t { some, nothing_yet, end };
  void forget_what_was_typed();
  void look();
  void wait();
  void tell(std::optional<std::string> line);
  [[nodiscard]] bool ready() const;
  [[nodiscard]] Read read_some();
  [[nodiscard]] std::optional<std::string> cut_line();

  boost::asio::io_context& context_;
  int descriptor_;
  bool terminal_;
  /// An epoll that watches the descriptor: Asio waits for this one, and makes this one non-blocking. Not open: the
  /// descriptor is a file or /dev/null, which never make anybody wait.
  boost::asio::posix::stream_descriptor readable_;
  std::string typed_;
  bool ended_ = false;
  OnLine on_line_;
  std::shared_ptr<int> alive_ = std::make_shared<int>();
};

}  // namespace axisgate
