// Edges: the client's memory of what it wrote to controlword, command and the coils, and the rules by which a write of
// them acts (design 3.3, "Edges", and 3.4, "Jog"). Promises that a scanner that writes the same block for ever starts
// nothing twice, and nothing by a press that was refused because another client owned the axis. Never asks what state
// the axis is in: a write that acts may still be refused by the axis.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {

/// "A request that writes one of them and nothing else is a single write, any other a block write."
enum class WriteForm : std::uint8_t { single, block };

/// How and when an item is written.
struct Writing {
  WriteForm form = WriteForm::single;
  Instant now;
  Duration rearm;  ///< listener option rearm_ms
};

/// command_id of one axis as one address has used it; outlives its connections by kIdsKept.
struct CommandIds {
  std::optional<std::uint16_t> last;
  bool zero_written = false;
};

/// Bit 1 = 0, bit 2 = 0, or bits 0..3 = 6 or 7: a stop, where it acts (design 3.4, "Stops").
[[nodiscard]] bool is_stop_controlword(std::uint16_t controlword);

/// What one request writes to the two jog coils; no value: it does not hold this one.
struct JogWrite {
  std::optional<bool> forward{};
  std::optional<bool> reverse{};
};
struct JogAsks {
  bool ends = false;
  std::optional<Command> start{};  ///< jog_forward or jog_reverse
  std::optional<Command> again{};  ///< jog_forward or jog_reverse: its coil, which was 1, is written 1 once more
};

class EdgeMemory {
 public:
  // Each remembers what is written and says whether it acts.
  [[nodiscard]] bool controlword(std::uint16_t value, const Writing& writing);
  /// In a request without a command_id, or with command_id 0.
  [[nodiscard]] bool command(Command value, const Writing& writing);
  /// In a request with a command_id other than 0.
  [[nodiscard]] bool command_with_id(Command value, std::uint16_t id, CommandIds& ids, Instant now);
  /// What the write asks for; no value where it does not act. Not of the jog coils.
  [[nodiscard]] std::optional<Command> coil(const CoilRow& coil, bool value, const Writing& writing);
  /// Both jog coils at once, since each looks at the other: 0 -> 1 starts, 1 -> 0 and both at 1 end. No time makes a
  /// held coil start anew.
  [[nodiscard]] JogAsks jog(const JogWrite& write, const Writing& writing);

  /// Register 54 as this client reads it.
  [[nodiscard]] std::uint16_t last_command() const { return command_.value; }
  /// What acted in the request at `when` was refused and did nothing: the next single write of it is no second press.
  void forget_presses(Instant when);
  /// The request at `when` was refused because another client owns the axis. What it wrote stays remembered, so that a
  /// level that is written on and on starts nothing on the day on which the axis is free: 0 and then 1 does. But a
  /// level that rose in it was never taken, so its fall asks for nothing: a button that was pressed in vain must not
  /// stop the owner's motion when it is let go.
  void disown(Instant when);
  /// The request at `when` was accepted: levels in it are this client's now, and their fall acts.
  void own(Instant when);

 private:
  struct Item {
    bool written = false;  ///< false: the memory is empty
    std::uint16_t value = 0;
    Instant at = kLongAgo;
    Instant since = kLongAgo;  ///< when it was first written with this value
    bool disowned = false;     ///< a 1 that another client's ownership has refused
    bool spent = false;        ///< a jog coil's 1 that has ended with both coils at 1
    [[nodiscard]] bool is_on() const { return written && value != 0; }
  };
  [[nodiscard]] static bool acts(const Item& item, std::uint16_t value, bool is_stop, const Writing& writing);
  static void remember(Item& item, std::uint16_t value, Instant now);
  [[nodiscard]] static bool swallows_fall(const Item& item, bool value);

  Item controlword_;
  Item command_;
  std::array<Item, kCoils> coils_{};
};

}  // namespace axisgate::modbus_tcp
