// SPDX-License-Identifier: Apache-2.0
// What becomes of a drive's watch over the gateway when the gateway ends on purpose, or lets go of it (design 3.4 The
// end on purpose). Pure. Promises that the entries which make the drive miss the gateway (1016h, 100Ch, 6007h, or what
// the profile names) are cleared only after a read has shown that no motor of it has torque; that the state is read
// once more afterwards, and that anything but that puts them back; that a drive of which this is not known is left as
// it is. Never clears an entry that holds another number than the setup list's.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/state/object_store.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

class Disarming {
 public:
  /// Attempts to put back what has been cleared, when the drive does not answer.
  static constexpr int kTries = 3;

  enum class Outcome : std::uint8_t {
    nothing_to_do,  ///< no entry makes this drive miss the gateway, or none is as the setup list has it
    disarmed,
    disabled,  ///< only looked: no motor has torque
    enabled,   ///< left armed: a motor has torque
    unknown,   ///< left armed: its state could not be read
    uncertain  ///< it should be armed, and did not answer when it was put back
  };

  explicit Disarming(const model::DriveModel& model) : model_(model) {}

  /// `store`: of a drive that is online; what is read from now on counts. `broken_off`: it was being brought up, and
  /// which entries were written by then is read first.
  void begin(const ObjectStore& store, bool broken_off = false);
  /// Whether a motor has torque is read, and nothing is written: disabled, enabled or unknown.
  void begin_look(const ObjectStore& store);
  /// Nothing can be asked of the drive: its state is unknown.
  void give_up() { end(Outcome::unknown); }
  struct Next {
    model::ObjectId object = model::kNoObject;
    bool write = false;
    std::int64_t number = 0;
  };
  /// The next exchange; none: it is over. The same answer until on_result().
  [[nodiscard]] std::optional<Next> next() const;
  /// Of the exchange given by next(); the store has taken what it brought. `trusted`: its reply can be no late one.
  void on_result(const bus::ExchangeResult& result, bool trusted, const ObjectStore& store);
  [[nodiscard]] Outcome outcome() const { return outcome_; }

 private:
  enum class Phase : std::uint8_t { look_at_entries, look, clear, look_again, put_back, over };
  void end(Outcome outcome);
  void put_back(Outcome outcome);
  void look(Phase phase, const ObjectStore& store);
  void gather_states();
  void next_state(const ObjectStore& store);
  [[nodiscard]] static bool is_armed(const model::ObjectWrite& entry, const ObjectStore& store);
  [[nodiscard]] bool holds_any_motor(const ObjectStore& store) const;

  const model::DriveModel& model_;
  Phase phase_ = Phase::over;
  Outcome outcome_ = Outcome::nothing_to_do;
  std::vector<model::ObjectWrite>
      entries_;  ///< in the order in which they are cleared: the last one of the setup list first
  std::vector<model::ObjectId> states_;  ///< what the statuswords of all axes are made from
  std::size_t at_ = 0;
  std::size_t cleared_ = 0;  ///< so many entries may hold 0
  int tries_ = 0;
};

/// For the log: "watch over the gateway switched off: no motor has torque".
[[nodiscard]] std::string_view text(Disarming::Outcome outcome);

}  // namespace axisgate::drive
