// SPDX-License-Identifier: Apache-2.0
// Edges: the client's memory of what it wrote to controlword, command and the coils, and the rules by which a write of
// them acts (design 3.3 Edges, 3.4 Jog). Promises that a scanner that writes the same block for ever starts
// nothing twice, that nothing starts by a connection's first block, and that what does not act says so wherever its
// client could believe that it had. Never asks what state the axis is in but for the level coils, whose 1 is no
// standing right: a write that acts may still be refused by the axis.
#pragma once

#include <array>
#include <bitset>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/image/axis_record.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {

/// A single write is FC 5, 6, 22, or FC 15 or 16 with exactly one row; everything else, and every FC 23, is a block
/// write.
enum class WriteForm : std::uint8_t { single, block };

/// Offsets of the jog coils in the unit's coils (design 3.4).
inline constexpr std::uint16_t kJogForward = jog_coil(Command::jog_forward);
inline constexpr std::uint16_t kJogReverse = jog_coil(Command::jog_reverse);

/// What one connection itself wrote last to one axis, whatever others of its address, or of its client, have written
/// since. What it repeats in a block starts nothing, and a coil that it holds nothing at all.
struct LastWords {
  std::optional<std::uint16_t> controlword{};
  std::optional<std::uint16_t> command{};
  std::optional<std::uint16_t> id{};  ///< that was not 0
  std::bitset<kCoils> coils{};        ///< those that it wrote 1
};

/// How and when an item is written, by whom, and what the axis is like.
struct Writing {
  WriteForm form = WriteForm::single;
  Instant now;
  std::uint64_t request = 0;  ///< its number among the client's, from 1: two may come in one instant
  Duration rearm;             ///< listener option rearm_ms
  ClientId client = 0;
  LastWords own{};                     ///< of the connection that writes, before this write
  Instant connected_at = kLongAgo;     ///< the same connection
  const AxisRecord* record = nullptr;  ///< of the axis; none: nothing has ever ended
  bool enabled = false;                ///< coil 0 reads 1, and no stop is latched: an enable has nothing to do
  bool runs_velocity = false;          ///< coil 7 reads 1
  bool owns = false;                   ///< this client owns the axis: a release has something to give back
  bool needs_zero = false;             ///< stop-latched or faulted: coil 0 = 1 acts only after a 0
  /// RowMemory's count of changes of what the item goes by.
  std::uint64_t targets = 0;
};

enum class Verdict : std::uint8_t {
  nothing,  ///< it asks for nothing, or for what it has asked for already
  acts,
  not_new,  ///< it does not act, and its client must be answered so (command_result 10)
};

/// command_id of one axis as one address has used it; outlives its connections by kHostKept.
struct CommandIds {
  std::optional<std::uint16_t> last;  ///< the last that was not 0
  std::optional<std::uint16_t> seen;  ///< the last that acted, or came with command 0: register 30
  Instant last_at = kLongAgo;         ///< when `last` was written last
  AxisRecord::Point since = 0;        ///< of the axis, when it became the last one
  /// What another program of the address has written over. A successor of a connection comes after all that this has
  /// written, so a connection that was there before is another program's.
  struct Overtaken {
    std::uint16_t id = 0;
    AxisRecord::Point since = 0;
  };
  static constexpr std::size_t kMaxOvertaken = 4;  ///< the oldest is forgotten
  boost::container::static_vector<Overtaken, kMaxOvertaken> overtaken{};
};

/// Bit 1 = 0, bit 2 = 0, or bits 0..3 = 6 or 7: a stop, where it acts (design 3.4 Stops).
[[nodiscard]] constexpr bool is_stop_controlword(std::uint16_t controlword) { return is_stop(controlword, true); }

/// What one request writes to the two jog coils; no value: it does not hold this one.
struct JogWrite {
  std::optional<bool> forward{};
  std::optional<bool> reverse{};
};
struct JogAsks {
  bool ends = false;               ///< its client's own jog
  bool ends_run = false;           ///< whoever runs it: both have come to be 1
  std::optional<Command> start{};  ///< jog_forward or jog_reverse
  std::optional<Command> again{};  ///< jog_forward or jog_reverse: its coil, which was 1, is written 1 once more
  bool not_new = false;            ///< a 1 before this client has written a 0
};

struct CoilAsks {
  Verdict verdict = Verdict::nothing;
  Command command = Command::none;  ///< where it acts
};

class EdgeMemory {
 public:
  // Each remembers what is written and says whether it acts.
  [[nodiscard]] Verdict controlword(std::uint16_t value, const Writing& writing);
  /// In a request without a command_id, or with command_id 0.
  [[nodiscard]] Verdict command(Command value, const Writing& writing);
  /// In a request with a command_id other than 0: only the id decides. It is new if it is neither the last one of its
  /// address nor the last one of its connection; nor, as the first one of a connection, an overtaken one whose action a
  /// stop, a fault or a loss has ended since.
  [[nodiscard]] Verdict command_with_id(Command value, std::uint16_t id, CommandIds& ids, const Writing& writing);
  /// Not of the jog coils.
  [[nodiscard]] CoilAsks coil(const CoilRow& coil, bool value, const Writing& writing);
  /// Both jog coils at once, since each looks at the other: 0 -> 1 starts, 1 -> 0 and both at 1 end, and where
  /// both have come to be 1 a run ends as well. No time makes a held coil start again.
  [[nodiscard]] JogAsks jog(const JogWrite& write, const Writing& writing);
  /// A block of nothing but zeros: remembered; true where controlword goes from another value to 0, which is a stop.
  [[nodiscard]] bool zeros(const Writing& writing);

  /// Nothing was written to `command`, or to `controlword`, yet.
  [[nodiscard]] bool command_empty() const { return !command_.written; }
  [[nodiscard]] bool controlword_empty() const { return !controlword_.written; }
  /// Register 54 as this client reads it.
  [[nodiscard]] std::uint16_t last_command() const { return command_.value; }
  // What became of a request, by its number.
  /// A part of it was carried out: what stood for that has been pressed, however the rest ends.
  void controlword_done(std::uint64_t request);
  void command_done(std::uint64_t request, Command command);
  /// It failed: of what was not carried out the next single write is no second press. `sent`: a part of it reached the
  /// drive, so it has acted: after another client's stop, a fault or a loss something else must come first all the
  /// same.
  void forget_presses(std::uint64_t request, bool sent);
  /// It was refused because another client owns the axis. What it wrote stays remembered, so that a
  /// level that is written on and on starts nothing on the day on which the axis is free: 0 and then 1 does. But a
  /// level that rose in it was never taken, so its fall in a block asks for nothing: a panel's row of coils must not
  /// stop the owner's motion when a button that was pressed in vain is released.
  void disown(std::uint64_t request);
  /// It was accepted: levels in it are this client's now, and their fall acts.
  void own(std::uint64_t request);

 private:
  struct Item {
    bool written = false;  ///< false: the memory is empty
    std::uint16_t value = 0;
    Instant at = kLongAgo;                   ///< written last
    std::uint64_t request = 0;               ///< that wrote it last
    std::uint64_t since = 0;                 ///< the request that first wrote this value
    bool done = false;                       ///< what `request` asked by it was carried out
    std::optional<AxisRecord::Point> acted;  ///< when it acted last with this value
    std::uint64_t targets = 0;               ///< Writing::targets then
    bool answered_not_new = false;           ///< its client was answered once that it is not new
    bool disowned = false;                   ///< a 1 that another client's ownership has refused
    [[nodiscard]] bool is_on() const { return written && value != 0; }
  };
  /// What kind of item it is, as far as the rules differ.
  struct Kind {
    bool stop = false;        ///< asserted: commands 2 to 4, coils 2 and 3 = 1
    bool stop_word = false;   ///< a controlword that is a stop where it acts
    bool relative = false;    ///< a relative move: one that is not new always says so
    bool unserved = false;    ///< a release of an axis that its client owns: never "done already"
    bool is_so = false;       ///< what it asks for is so already: repeating it is answered normally
    bool held_start = false;  ///< commands 6 to 10: a target beside it asks for a start that does not come
  };
  /// `own`: what the connection wrote to it last.
  [[nodiscard]] static Verdict judge(Item& item, std::uint16_t value, const Kind& kind, const Writing& writing,
                                     std::optional<std::uint16_t> own = std::nullopt);
  [[nodiscard]] static Verdict judge_single(const Item& item, const Kind& kind, const Writing& writing);
  [[nodiscard]] static Verdict judge_level(const Item& item, const CoilRow& coil, bool value, const Writing& writing);
  static void remember(Item& item, std::uint16_t value, const Writing& writing);
  static Verdict conclude(Item& item, std::uint16_t value, Verdict verdict, const Writing& writing);

  Item controlword_;
  Item command_;
  std::array<Item, kCoils> coils_{};
};

}  // namespace axisgate::modbus_tcp
