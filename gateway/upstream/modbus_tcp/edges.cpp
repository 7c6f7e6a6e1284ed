#include "gateway/upstream/modbus_tcp/edges.hpp"

namespace axisgate::modbus_tcp {

bool is_stop_controlword(std::uint16_t controlword) {
  const unsigned steps = controlword & 0x0FU;
  return (controlword & 0x02U) == 0 || (controlword & 0x04U) == 0 || steps == 6 || steps == 7;
}

/// `is_stop`: a stop by itself (commands 2 to 4, coils 2 and 3 = 1). Coils 0 and 7 going 1 -> 0 and a controlword are
/// stops only where they act by the edge rule, so they are no exception to it here.
bool EdgeMemory::acts(const Item& item, std::uint16_t value, bool is_stop, const Writing& writing) {
  const bool differs = value != item.value;
  if (writing.form == WriteForm::block) {
    // "The item acts if its memory is not empty and the value differs; with an empty memory it is only remembered,
    // except a stop that is asserted, which acts."
    return item.written ? differs : is_stop;
  }
  // "Acts if the memory is empty, or the value differs, or this client has not written the item for rearm_ms." A stop
  // is idempotent: pressed twice it counts once either way, and a press is never swallowed because of one that came
  // before.
  const bool rearmed = item.at == kLongAgo || writing.now - item.at >= writing.rearm;
  return !item.written || differs || rearmed || is_stop;
}

void EdgeMemory::remember(Item& item, std::uint16_t value, Instant now) { item = {true, value, now}; }

bool EdgeMemory::controlword(std::uint16_t value, const Writing& writing) {
  const bool acting = acts(controlword_, value, false, writing);
  remember(controlword_, value, writing.now);
  return acting;
}

bool EdgeMemory::command(Command value, const Writing& writing) {
  const auto number = static_cast<std::uint16_t>(value);
  // "0 in `command` does nothing and arms it."
  const bool acting = value != Command::none && acts(command_, number, axisgate::is_stop(value), writing);
  remember(command_, number, writing.now);
  return acting;
}

bool EdgeMemory::command_with_id(Command value, std::uint16_t id, CommandIds& ids, Instant now) {
  // "`command` acts if the id differs from the last one for this axis from the same address; the first id is only
  // remembered, unless id 0 was written before it." A stop acts with the first id too, as it does with an empty memory:
  // nothing is known yet of this client, and a stop too many is the smaller harm.
  const bool first = !ids.last.has_value();
  const bool counts = first ? ids.zero_written || axisgate::is_stop(value) : id != *ids.last;
  ids.last = id;
  remember(command_, static_cast<std::uint16_t>(value), now);
  return counts && value != Command::none;
}

std::optional<Command> EdgeMemory::coil(const CoilRow& coil, bool value, const Writing& writing) {
  Item& item = coils_.at(coil.offset);
  const Command asked = value ? coil.on : coil.off;
  bool acting = acts(item, value ? 1 : 0, value && axisgate::is_stop(coil.on), writing);
  if (coil.level && !axisgate::is_stop(asked)) {
    // "A level of 1 is no standing right: after a stop, a fault, a link loss or another client's command it acts only
    // after 0 -> 1." So writing the same level again never starts anything, however long ago the last write was.
    acting = acting && (!item.written || item.value != (value ? 1 : 0));
  }
  // "Edge coils act on 0 -> 1": a 0 does nothing and arms it.
  if (asked == Command::none) acting = false;
  remember(item, value ? 1 : 0, writing.now);
  return acting ? std::optional(asked) : std::nullopt;
}

void EdgeMemory::forget_presses(Instant when) {
  const auto forget = [when](Item& item) {
    if (item.at == when) item.at = kLongAgo;
  };
  forget(controlword_);
  forget(command_);
  for (Item& item : coils_) forget(item);
}

}  // namespace axisgate::modbus_tcp
