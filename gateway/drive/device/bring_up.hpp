// SPDX-License-Identifier: Apache-2.0
// Bring-up of a drive (design 7, point 6): its state is read first; then everything the image needs, the checks,
// its identity; then the setup is written, and a CANopen node mapped and started. Promises that a drive found enabled
// is adopted, and one that is not the configured one left alone: nothing is written to either; and that a setup value
// is written only where the drive holds another, and read back. Never enables, moves or stops anything.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/device/node_setup.hpp"
#include "gateway/drive/device/node_start.hpp"
#include "gateway/drive/device/object_tries.hpp"
#include "gateway/drive/device/poll_plan.hpp"
#include "gateway/drive/state/object_store.hpp"

namespace axisgate::drive {

class BringUp {
 public:
  /// `timeout`: of its bus.
  BringUp(const model::DriveModel& model, Duration timeout);

  void begin();
  struct Next {
    model::ObjectId object = model::kNoObject;
    bool write = false;
    std::int64_t number = 0;
    std::optional<bus::Exchange> exchange{};  ///< instead of an object of the model: identity, mapping, NMT
  };
  /// The next exchange; none: bring-up is over. The same answer until the store shows its effect.
  [[nodiscard]] std::optional<Next> next(const ObjectStore& store);
  /// Of the exchange given by next(): a write is read back next, or has as many tries as a read (ObjectTries), ever
  /// later, where it is refused for now. What is not answered is asked again; a Next::exchange is given up in the end.
  void on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result, const ObjectStore& store,
                 Instant now);
  /// The write given by next() is not to be sent before.
  [[nodiscard]] Instant write_again() const { return write_again_; }
  /// A drive that is brought up refused some of its setup for now: when it is tried again; kNever: it did not.
  [[nodiscard]] Instant amend_due() const { return amend_due_; }
  /// From now on next() gives what was refused for now and is still due by what the drive holds, once each, and nothing
  /// else.
  void begin_amending(const ObjectStore& store, Instant now);
  [[nodiscard]] bool amending() const { return amending_; }
  /// What is left of it is tried again later.
  void end_amending(Instant now);
  /// The read given by next() is of what was just written: it does not wait for its turn.
  [[nodiscard]] bool reads_back() const { return read_back_; }
  /// Some axis was found enabled: of its setup nothing is written until leave().
  [[nodiscard]] bool adopted() const { return adopted_; }
  void leave() { adopted_ = false; }
  /// Setup values that the drive does not hold although they were written: they are named in an event.
  [[nodiscard]] const std::vector<model::ObjectId>& unheld() const { return unheld_; }
  [[nodiscard]] bool has_setup() const { return !model_.setup.empty() || !model_.factory_writes.empty() || is_node(); }
  /// How the drive differs from the configured one; empty: it does not.
  [[nodiscard]] const std::string& mismatch() const { return identity_.mismatch(); }
  /// It refuses what its profile needs; empty: it has it all. True: that is news, to be reported.
  bool found_lacking(const std::string& what) {
    const std::string before = std::exchange(lacks_, what);
    completed_ = what.empty() && (completed_ || !before.empty());
    return before != what && !what.empty();
  }
  /// What it lacked is there: its setup, which was left alone, is due.
  [[nodiscard]] bool completed() const { return completed_; }
  /// It is what the configuration and its profile say.
  [[nodiscard]] bool is_configured() const { return mismatch().empty() && lacks_.empty(); }
  /// Whether a CANopen node stays started.
  [[nodiscard]] NodeStart& start() { return start_; }
  /// What a CANopen node sends by itself now, and what it would not.
  [[nodiscard]] const NodeSetup& node() const { return node_; }

 private:
  void written();
  void write_refused(bool for_now, Instant now);
  [[nodiscard]] bool any_enabled(const ObjectStore& store) const;
  [[nodiscard]] bool is_node() const { return model::is_canopen(model_); }
  [[nodiscard]] bool lacks_needed(const ObjectStore& store) const;
  [[nodiscard]] std::vector<model::ObjectWrite> setup_due(const ObjectStore& store) const;
  [[nodiscard]] std::optional<Next> next_setup(const ObjectStore& store);
  const model::DriveModel& model_;
  IdentityCheck identity_;
  NodeSetup node_;
  NodeStart start_;
  std::vector<model::ObjectId> reads_;
  std::vector<model::ObjectId> confirmed_;  ///< class fast, the statuswords among them: read once more at the end
  std::size_t read_at_ = 0;
  std::optional<std::uint64_t> confirm_after_;  ///< exchange: the state is read once more before the first setup write
  std::optional<std::vector<model::ObjectWrite>> setup_;  ///< as it is due by what was read; none: not judged yet
  std::size_t setup_at_ = 0;
  bool setup_written_ = false;
  bool read_back_ = false;
  bool adopted_ = false;
  int exchange_tries_ = 0;  ///< in a row
  int write_tries_ = 0;
  Instant write_again_ = kLongAgo;
  std::vector<model::ObjectWrite> refused_for_now_;
  Duration amend_pause_{};
  Instant amend_due_ = kNever;
  bool amending_ = false;
  std::string lacks_;
  bool completed_ = false;
  std::vector<model::ObjectId> unheld_;
};

}  // namespace axisgate::drive
