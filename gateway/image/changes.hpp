// SPDX-License-Identifier: Apache-2.0
// Which axes have changed since a server looked last: so that it need not look at all of them all the time.
// Promises each reader that no change is missed: whoever is woken finds every axis that was marked since it took the
// marks. Never says what has changed, and never calls anybody but to wake it.
#pragma once

#include <bitset>
#include <functional>
#include <utility>
#include <vector>

namespace axisgate {

/// Axis 0 stands for the event ring.
class ChangeBoard {
 public:
  static constexpr std::size_t kPlaces = 500;

  /// One server's marks, as long as it lives; the board outlives it.
  class Reader {
   public:
    /// `wake`: called at the first axis that is marked after a take(), and at the first event after a take() or a
    /// take_event(), inside whatever changes the image: it may arm a timer, and no more.
    Reader(ChangeBoard& board, std::function<void()> wake) : board_(board), wake_(std::move(wake)) {
      board_.readers_.push_back(this);
    }
    ~Reader() { std::erase(board_.readers_, this); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    /// Calls `each` with every marked axis in the order of their numbers, and forgets the marks and the event.
    template <typename Each>
    void take(Each&& each) {
      event_ = false;
      if (marks_.none()) return;
      const auto marked = std::exchange(marks_, {});
      for (std::size_t i = 0; i < kPlaces; ++i)
        if (marked.test(i)) each(i);
    }
    /// Forgets the event alone: of a reader that takes axes at its own pace.
    void take_event() { event_ = false; }
    /// An axis is marked.
    [[nodiscard]] bool any() const { return marks_.any(); }

   private:
    friend class ChangeBoard;
    void mark(std::size_t axis) {
      const bool first = axis == 0 ? !std::exchange(event_, true) : marks_.none();
      if (axis != 0) marks_.set(axis);
      if (first) wake_();
    }
    ChangeBoard& board_;
    std::function<void()> wake_;
    std::bitset<kPlaces> marks_;
    bool event_ = false;
  };

  void mark(std::size_t axis) {
    for (Reader* reader : readers_) reader->mark(axis);
  }

 private:
  std::vector<Reader*> readers_;
};

}  // namespace axisgate
