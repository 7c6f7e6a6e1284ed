// SPDX-License-Identifier: Apache-2.0
// The write batches of one axis that wait for the wire or are under way, oldest first, and what they say of each other:
// what is asked of the axis, and which of them waits for a stop. Promises that a stop waits for nothing here, and that
// what would enable or start waits for each stop before it. Never carries one out: the axis does.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bus/bus_job.hpp"
#include "gateway/drive/command_sequence/command_sequence.hpp"
#include "gateway/image/axis_record.hpp"
#include "gateway/image/command_port.hpp"

namespace axisgate::drive {

/// A client that waits for a result. Those that share a bus job keep a deadline each.
struct Waiting {
  BatchCallback tell;
  Instant start_by = kNever;   ///< nothing sent by then: never_started; of a stop: kNever
  Instant answer_by = kNever;  ///< no result by then: timed_out
};

/// A write batch that was accepted.
struct Pending {
  bus::JobId id = 0;
  std::unique_ptr<CommandSequence> command_sequence;
  std::vector<Waiting> callbacks;
  Instant start_by = kNever;       ///< the latest of theirs: the bus ends the bus job then
  AxisRecord::Point accepted = 0;  ///< of a stop: the newest stop then
  bool starts_motion = false;
  bool claims_when_begun = false;  ///< as things stood when it came, nothing of it was accepted
  bool by_mailbox = false;
  bool jogs = false;                     ///< it starts a jog
  AxisRecord::Point ends_jog = 0;        ///< once it has started what it starts, this jog is over
  Errc refusal = Errc::ok;               ///< of what stood beside the stop; the answer once the stop is done
  std::optional<ClientId> stopped_by{};  ///< whose stop came first after it
  std::string stopped_by_name{};         ///< for log and events
  /// What the refusal is of.
  std::optional<std::uint16_t> refused_row{};

  [[nodiscard]] const WriteBatch& batch() const { return command_sequence->batch(); }
  /// What it asks for begins by then, and no more once all who wait for it are answered.
  [[nodiscard]] Instant begins_by() const {
    Instant answered = callbacks.empty() ? kNever : kLongAgo;
    for (const Waiting& client : callbacks) answered = std::max(answered, client.answer_by);
    return command_sequence->begun() ? answered : std::min(answered, start_by);
  }
};

class PendingBatches : private std::vector<Pending> {
 public:
  using std::vector<Pending>::begin;
  using std::vector<Pending>::empty;
  using std::vector<Pending>::end;
  using std::vector<Pending>::erase;
  using std::vector<Pending>::push_back;
  using std::vector<Pending>::rbegin;
  using std::vector<Pending>::rend;

  /// That of this bus job; null: none.
  [[nodiscard]] Pending* find(bus::JobId id);
  [[nodiscard]] const Pending* find(bus::JobId id) const { return const_cast<PendingBatches*>(this)->find(id); }
  /// The bus job whose long object is under way; 0: none.
  [[nodiscard]] bus::JobId chain_job() const;

  // --- What is asked of the axis ------------------------------------------------------------------------------------

  [[nodiscard]] bool starts_motion() const;
  [[nodiscard]] bool jogs() const;
  /// By a command, or by a word that enables in a mode that runs.
  [[nodiscard]] bool runs(const AxisCore& core) const;
  /// A homing, or what moves the zero.
  [[nodiscard]] bool moves_zero() const;
  /// An enable waits for the wire or (`begun`: only that) is under way.
  [[nodiscard]] bool enables(bool begun = false) const;
  /// A disable waits for the wire.
  [[nodiscard]] bool disables() const;
  /// Of anybody: it waits for the wire or has begun, and is neither a stop nor a mere read.
  [[nodiscard]] bool writes() const;
  /// What will end a stop that is owed, once it is begun; `halt`: a start does as well.
  [[nodiscard]] bool ends_owed_stop(bool halt) const;

  // --- Stops go first -----------------------------------------------------------------------------------------------

  /// A stop waits for the wire or is under way.
  [[nodiscard]] bool stopping() const;
  /// The same, or what stood beside one.
  [[nodiscard]] bool carries_out_stop() const;
  [[nodiscard]] bool waits_for_stop(const Pending& pending) const;
  [[nodiscard]] bool is_behind_rest_of_stop(const Pending& pending) const;
  /// A stop that has not been sent yet, or, of the bus job on the wire, one that will be sent once more.
  [[nodiscard]] bool insists(bus::JobId id) const;
};

}  // namespace axisgate::drive
