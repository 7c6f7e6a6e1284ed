#include "gateway/upstream/modbus_tcp/edges.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr std::size_t kJogForward = 8;  // offsets of the coils
constexpr std::size_t kJogReverse = 9;

}  // namespace

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

void EdgeMemory::remember(Item& item, std::uint16_t value, Instant now) {
  if (!item.written || item.value != value) item = {.written = true, .value = value, .since = now};
  item.at = now;
}

bool EdgeMemory::swallows_fall(const Item& item, bool value) { return !value && item.is_on() && item.disowned; }

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
  const bool swallowed = swallows_fall(item, value);
  remember(item, value ? 1 : 0, writing.now);
  // Whoever meant it as a stop writes the 0 again, and that one acts at once.
  if (swallowed) item.at = kLongAgo;
  return acting && !swallowed ? std::optional(asked) : std::nullopt;
}

JogAsks EdgeMemory::jog(const JogWrite& write, const Writing& writing) {
  struct Side {
    Item& item;
    std::optional<bool> value;
    Command start;
    bool was_on;
    bool counts;  // not only remembered
    [[nodiscard]] bool on() const { return value.value_or(was_on); }
    [[nodiscard]] bool rises() const { return counts && *value && !was_on; }
    /// A single 0 from a connection that has written nothing yet is a button that is let go after a reconnect.
    [[nodiscard]] bool falls() const { return counts && !*value && (was_on || !item.written) && !item.disowned; }
  };
  const auto side_of = [&](std::size_t coil, std::optional<bool> value, Command start) {
    Item& item = coils_.at(coil);
    return Side{item, value, start, item.is_on(), value && (item.written || writing.form == WriteForm::single)};
  };
  const std::array sides{side_of(kJogForward, write.forward, Command::jog_forward),
                         side_of(kJogReverse, write.reverse, Command::jog_reverse)};

  JogAsks asks;
  const bool both = sides[0].on() && sides[1].on();
  for (const Side& side : sides) {
    if (side.falls() || (both && side.counts && *side.value)) asks.ends = true;
    const bool held = side.value.value_or(false) && side.was_on && !side.item.disowned && !side.item.spent;
    if (!both && side.rises()) asks.start = side.start;
    if (!both && held) asks.again = side.start;
  }
  for (const Side& side : sides) {
    if (side.value) remember(side.item, *side.value ? 1 : 0, writing.now);
    if (both) side.item.spent = true;
  }
  return asks;
}

void EdgeMemory::forget_presses(Instant when) {
  const auto forget = [when](Item& item) {
    if (item.at == when) item.at = kLongAgo;
  };
  forget(controlword_);
  forget(command_);
  for (Item& item : coils_) forget(item);
}

void EdgeMemory::disown(Instant when) {
  for (const CoilRow& coil : coil_rows()) {
    Item& item = coils_.at(coil.offset);
    // A stop is carried out whoever owns the axis.
    if (item.is_on() && item.since == when && !axisgate::is_stop(coil.on)) item.disowned = true;
  }
}

void EdgeMemory::own(Instant when) {
  for (Item& item : coils_)
    if (item.at == when) item.disowned = false;
}

}  // namespace axisgate::modbus_tcp
