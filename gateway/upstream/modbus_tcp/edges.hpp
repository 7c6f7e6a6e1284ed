// Edges: the client's memory of what it wrote to controlword, command and the coils, and the rules by which a write of
// them acts (design 3.3, "Edges"). Promises that a scanner that writes the same block for ever starts nothing twice.
// Never asks what state the axis is in: a write that acts may still be refused by the axis.
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

class EdgeMemory {
 public:
  // Each remembers what is written and says whether it acts.
  [[nodiscard]] bool controlword(std::uint16_t value, const Writing& writing);
  /// In a request without a command_id, or with command_id 0.
  [[nodiscard]] bool command(Command value, const Writing& writing);
  /// In a request with a command_id other than 0.
  [[nodiscard]] bool command_with_id(Command value, std::uint16_t id, CommandIds& ids, Instant now);
  /// What the write asks for; no value where it does not act.
  [[nodiscard]] std::optional<Command> coil(const CoilRow& coil, bool value, const Writing& writing);

  /// Register 54 as this client reads it.
  [[nodiscard]] std::uint16_t last_command() const { return command_.value; }
  /// What acted in the request at `when` was refused and did nothing: the next single write of it is no second press.
  void forget_presses(Instant when);

 private:
  struct Item {
    bool written = false;  ///< false: the memory is empty
    std::uint16_t value = 0;
    Instant at = kLongAgo;
  };
  [[nodiscard]] static bool acts(const Item& item, std::uint16_t value, bool is_stop, const Writing& writing);
  static void remember(Item& item, std::uint16_t value, Instant now);

  Item controlword_;
  Item command_;
  std::array<Item, kCoils> coils_{};
};

}  // namespace axisgate::modbus_tcp
