// SPDX-License-Identifier: Apache-2.0
// A drive when the gateway ends on purpose, or lets go of it (design 3.4 The end on purpose). Pure. Promises that what
// makes the drive miss the gateway is asked about only once its stops are at their end, that it is over once, and that
// where nothing was read before nothing is asked. Never sends; what may be cleared is Disarming's to decide.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/device/disarming.hpp"

namespace axisgate::drive {

/// Why a drive is closed.
enum class Closing : std::uint8_t {
  gateway_ends,  ///< where no motor has torque, the drive is set not to miss the gateway; any other one stops as if
                 ///< the gateway had died
  look,          ///< to be taken away, if no motor has torque: that is read, and nothing is written
  taken_away     ///< as gateway_ends, while the gateway goes on
};

/// What is known of the drive then.
enum class Known : std::uint8_t {
  nothing,  ///< it does not answer, or was not looked at
  in_part,  ///< it is being brought up
  whole     ///< it is online, and the store holds what it holds
};

class DriveEnd {
 public:
  /// Its stops are looked at again after so long.
  static constexpr Duration kStopsFirst = std::chrono::milliseconds(10);

  explicit DriveEnd(const model::DriveModel& model) : disarming_(model) {}

  /// True: there is something to be asked of it.
  bool begin(Closing why, Known known, const ObjectStore& store, std::function<void()> closed) {
    why_ = why;
    closed_ = std::move(closed);
    disarming_.give_up();
    if (known == Known::nothing || (known == Known::in_part && why == Closing::look)) return false;
    if (why == Closing::look)
      disarming_.begin_look(store);
    else
      disarming_.begin(store, known == Known::in_part);
    return true;
  }
  [[nodiscard]] bool begun() const { return why_.has_value(); }
  /// It stays after all: true where what makes it miss the gateway may have been cleared.
  bool take_back() {
    closed_ = nullptr;
    return std::exchange(why_, std::nullopt) != Closing::look;
  }

  /// The next exchange; none: there is none left.
  [[nodiscard]] std::optional<Disarming::Next> next() const { return disarming_.next(); }
  void on_result(const bus::ExchangeResult& result, bool trusted, const ObjectStore& store) {
    disarming_.on_result(result, trusted, store);
  }
  [[nodiscard]] Disarming::Outcome outcome() const { return disarming_.outcome(); }
  /// What the log says at its end; empty: nothing.
  [[nodiscard]] std::string event_text() const {
    if (why_ != Closing::gateway_ends || outcome() == Disarming::Outcome::nothing_to_do) return {};
    return "the gateway ends: " + std::string(text(outcome()));
  }
  /// Nothing of the drive is on the wire or waits for it: whom to answer, once; none: nobody, or the answer was given.
  [[nodiscard]] std::function<void()> take_closed() { return why_ ? std::exchange(closed_, nullptr) : nullptr; }

 private:
  Disarming disarming_;
  std::optional<Closing> why_{};
  std::function<void()> closed_{};
};

}  // namespace axisgate::drive
