// SPDX-License-Identifier: Apache-2.0
#include "gateway/listing/commands_page.hpp"

#include <array>
#include <map>

#include "gateway/core/error.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::listing {
namespace {

using enum MotorDoes;

constexpr std::array kWithIds{
    Cycle{"PLC", "command 0, command_id 0", 0, kAsBefore, 0, stands,
          "a block of zeros, as a scanner sends it before its program runs, asks for nothing"},
    Cycle{"PLC", "command 0, command_id 1", 0, kAsBefore, 0, stands,
          "so a program begins: nothing is asked, and the id is remembered"},
    Cycle{"PLC", "command 1, command_id 2", 0, 2, 1, stands, "another id: enable"},
    Cycle{"PLC", "", 0, 2, 1, stands, "the same id asks for nothing, however often it is sent"},
    Cycle{"PLC", "target_position 50000, command 6, command_id 3", 0, 2, 2, starts,
          "the set-point goes with the start"},
    Cycle{"PLC", "", 0, 2, 1, arrives, "the result stays as long as the id does"},
    Cycle{"PLC", "target_position 100000", 0, 2, 1, stands, "a set-point is no start: it is kept for the next one"},
    Cycle{"PLC", "command_id 4", 0, 2, 2, starts, "the same command with another id is new"},
    Cycle{"PLC", "command 3, command_id 5", 0, 2, 5, stops, "quick_stop; the stop is latched"},
    Cycle{"PLC", "command 6, command_id 6", 4, 9, 5, stands, "no start while it is latched"},
    Cycle{"PLC", "command 1, command_id 7", 0, 2, 1, stands, "enable clears the latch, and starts nothing"},
    Cycle{"PLC", "command 6, command_id 8", 0, 2, 2, starts, "to the target that was accepted last"},
    Cycle{"PLC", "", 0, 2, 1, arrives, ""},
    Cycle{"PLC", "command 2, command_id 9", 0, 2, 0, stands, "disable"},
};

constexpr std::array kWithoutIds{
    Cycle{"PLC", "command 1", 0, 10, 0, stands,
          "the first block is only remembered: a PLC that is started moves nothing"},
    Cycle{"PLC", "", 0, 10, 0, stands, "nor does the same block later"},
    Cycle{"PLC", "command 0", 0, 10, 0, stands, "so begin with 0"},
    Cycle{"PLC", "command 1", 0, 2, 1, stands, "enable: another command than the one remembered"},
    Cycle{"PLC", "target_position 50000, command 6", 0, 2, 2, starts, "1 to 6 is a change as well"},
    Cycle{"PLC", "", 0, 2, 1, arrives, ""},
    Cycle{"PLC", "target_position 100000", 0, 10, 1, stands,
          "the command stays 6, which is not new: result 10 says that the new target was only kept"},
    Cycle{"PLC", "command 0", 0, 10, 1, stands, "0 in between makes the next 6 new"},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, "to the target that was accepted last"},
    Cycle{"PLC", "command 3", 0, 2, 5, stops, "quick_stop; the stop is latched"},
    Cycle{"PLC", "command 6", 4, 9, 5, stands, "no start while it is latched"},
    Cycle{"PLC", "command 1", 0, 2, 1, stands, "enable clears the latch, and starts nothing"},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, "to the target that was accepted last"},
    Cycle{"PLC", "", 0, 2, 1, arrives, ""},
    Cycle{"PLC", "command 2", 0, 2, 0, stands, "disable"},
};

constexpr std::array kOneShot{
    Cycle{"PLC", "command 1", 0, 2, 1, stands, "a single write acts at once"},
    Cycle{"PLC", "command 1", 0, 2, 1, stands, "what is so already is answered normally"},
    Cycle{"PLC", "target_position 50000", 0, 2, 1, stands, "a set-point is no start"},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, ""},
    Cycle{"PLC", "command 6", 0, 2, 1, arrives, "the same move to the same target: done already"},
    Cycle{"PLC", "target_position 200000", 0, 2, 1, stands, ""},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, "a new connection remembers nothing, and a single write acts"},
    Cycle{"PLC", "command 3", 0, 2, 5, stops, "quick_stop"},
    Cycle{"PLC", "command 6", 4, 9, 5, stands, "no start while the stop is latched"},
    Cycle{"PLC", "command 1", 0, 2, 1, stands, "enable clears the latch, and starts nothing"},
    Cycle{"PLC", "command 2", 0, 2, 0, stands, "disable"},
};

constexpr std::array kWithPanel{
    Cycle{"PLC", "command 0, command_id 1", 0, kAsBefore, 0, stands, "remembered; nobody owns the axis"},
    Cycle{"PLC", "command 1, command_id 2", 0, 2, 1, stands, "the PLC owns it now"},
    Cycle{"panel", "target_position 10000", 6, 7, 1, stands, "only the owner's set-points are accepted"},
    Cycle{"PLC", "target_position 50000, command 6, command_id 3", 0, 2, 2, starts, ""},
    Cycle{"panel", "coil 2 = 1", 0, 2, 5, stops, "a stop is open to every operator: quick_stop by its coil"},
    Cycle{"PLC", "", 0, 2, 5, stands,
          "the same id starts nothing again: the start was done, and motion_state is 3, aborted"},
    Cycle{"PLC", "command_id 4", 4, 9, 5, stands, "nor does a new one while the stop is latched"},
    Cycle{"PLC", "command 1, command_id 5", 0, 2, 1, stands, "the owner clears it by an enable"},
    Cycle{"PLC", "command 6, command_id 6", 0, 2, 2, starts, ""},
    Cycle{"PLC", "", 0, 2, 1, arrives, ""},
    Cycle{"PLC", "command 2, command_id 7", 0, 2, 0, stands, "disabled: from here its lease runs out, scan or not"},
};

constexpr std::array kOneRow{
    Cycle{"PLC", "target_position 200000", 0, 2, 0, stands, "a set-point is kept for the start, also while disabled"},
    Cycle{"PLC", "coil 0 = 1", 0, 2, 1, stands, "a level coil; on an empty memory a single 1 enables"},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, ""},
    Cycle{"panel", "coil 2 = 1", 0, 2, 5, stops, "quick_stop"},
    Cycle{"PLC", "command 6", 6, 10, 5, stands, "somebody else has ended it, so the same command is not new: 0 first"},
    Cycle{"PLC", "coil 0 = 1", 6, 10, 5, stands, "nor is a level that stays 1"},
    Cycle{"PLC", "coil 0 = 0", 0, 2, 5, stands, "0 disables, and the latch stays"},
    Cycle{"PLC", "coil 0 = 1", 0, 2, 1, stands, "0 to 1 enables, which clears the latch"},
    Cycle{"PLC", "command 0", 0, kAsBefore, 1, stands, "0 asks for nothing, and makes the next 6 new"},
    Cycle{"PLC", "command 6", 0, 2, 2, starts, "to the target that was accepted last"},
    Cycle{"PLC", "command 0", 0, kAsBefore, 1, arrives, "it ends no motion"},
    Cycle{"PLC", "coil 0 = 0", 0, 2, 0, stands, "disable"},
};

constexpr std::array kTables{
    CycleTable{
        "A cyclic scanner with ids",
        "One connection; each cycle one block of registers 40 to 55, or to 56 with a heartbeat. The form to prefer.",
        CycleTable::How::scanner, false, true, kWithIds},
    CycleTable{"A cyclic scanner without ids", "The same with command_id 0 in every block.", CycleTable::How::scanner,
               false, true, kWithoutIds},
    CycleTable{"A one-shot client",
               "mbpoll, or a script that opens a connection for each request: one row at a time, no lease (`\"lease\": "
               "null`). Not on iD286pro, nor on a Keya over RS485: what nothing else would stop is stopped when the "
               "connection that has started it ends; there the listener needs `\"client\": \"address\"`.",
               CycleTable::How::single, true, false, kOneShot},
    CycleTable{"A client that writes one row at a time",
               "One connection that stays, rows and coils in requests of their own, no lease; and a panel with a stop "
               "button.",
               CycleTable::How::single, false, false, kOneRow},
    CycleTable{"PLC and panel on one axis", "A scanner with ids that owns the axis, and a panel with a stop button.",
               CycleTable::How::scanner, false, true, kWithPanel},
};

std::string_view text(MotorDoes motor) {
  constexpr std::array<std::string_view, 4> kTexts{"stands", "starts", "arrives", "stops"};
  return kTexts[static_cast<std::size_t>(motor)];
}

std::string cells(std::initializer_list<std::string> texts) {
  std::string out = "|";
  for (const std::string& each : texts) out += " " + each + " |";
  return out + "\n";
}

std::string numbered(WordKind kind, std::uint32_t number) {
  return std::to_string(number) + " " + std::string(name_of(kind, number));
}

std::string page_of(const CycleTable& table) {
  std::string out = "\n### " + std::string(table.title) + "\n\n" + std::string(table.text) +
                    "\n\n| cycle | client | writes | answer | result (25) | state (31) | motor | why |\n"
                    "|---|---|---|---|---|---|---|---|\n";
  int number = 0;
  for (const Cycle& cycle : table.cycles)
    out += cells({std::to_string(++number), std::string(cycle.client),
                  cycle.writes.empty() ? "the same" : std::string(cycle.writes),
                  cycle.exception == 0 ? "normal" : "exception 0x0" + std::to_string(cycle.exception),
                  cycle.result == kAsBefore ? "as before" : numbered(WordKind::result, cycle.result),
                  numbered(WordKind::axis_state, cycle.state), std::string(text(cycle.motor)), std::string(cycle.why)});
  return out;
}

struct CommandText {
  Command command;
  std::string_view does, needs, done;
};
constexpr std::array kCommands{
    CommandText{
        Command::enable,
        "torque on; never moves the axis: set-points in the drive are made harmless before; clears the stop latch",
        "no fault", "operation enabled was seen"},
    CommandText{Command::disable, "a stop: torque off, by the drive's disable option", "nothing",
                "not enabled was seen"},
    CommandText{Command::quick_stop, "a stop: the fastest controlled one of the drive; sets the stop latch", "nothing",
                "seen"},
    CommandText{Command::halt, "a stop: with profile_deceleration; stays enabled, and nothing resumes", "nothing",
                "seen"},
    CommandText{
        Command::fault_reset,
        "clears a fault whose cause is gone, and the axis ends disabled; without a fault nothing is sent, and an "
        "enabled axis stays so",
        "nothing", "no fault was seen"},
    CommandText{Command::move_absolute, "to target_position; replaces a move that is under way", "enabled, no latch",
                "it has begun"},
    CommandText{Command::move_relative, "by target_position; while it moves 0x06", "standstill, no latch",
                "it has begun"},
    CommandText{Command::run_velocity, "at target_velocity, a later one acts at once", "enabled, no latch",
                "it has begun"},
    CommandText{Command::run_torque, "with target_torque, a later one acts at once; needs max_velocity",
                "enabled, no latch", "it has begun"},
    CommandText{Command::home, "by homing_method", "enabled, no latch", "it has begun"},
    CommandText{Command::set_position, "the position becomes set_position_value, and nothing moves", "standstill",
                "read back"},
    CommandText{Command::save_parameters, "keeps the drive's parameters over a restart (engineer)", "disabled",
                "the drive says so, or 2 s"},
    CommandText{Command::release,
                "gives the lease back; an axis that is enabled stays so until the lease's time is over", "to own it",
                "at once"},
    CommandText{Command::take_over, "takes the axis from a client of a lower rank, after a halt", "a higher rank",
                "the halt is seen: it slows down, or stands"},
};

/// Which exception comes with which result, and why: the outcomes of gateway/core/error, in the order of both.
std::string outcomes() {
  std::map<std::pair<unsigned, unsigned>, std::string> rows;
  for (int number = 0; number < kErrcCount; ++number) {
    const auto code = static_cast<Errc>(number);
    std::string& reasons =
        rows[{static_cast<unsigned>(modbus_exception(code)), static_cast<unsigned>(command_result(code))}];
    reasons += (reasons.empty() ? "" : "; ") + std::string(axisgate::text(code));
  }
  std::string out = "| answer | result (25) | because |\n|---|---|---|\n";
  for (const auto& [outcome, reasons] : rows) {
    const auto& [answer, result] = outcome;
    const std::string named = answer == 0 ? "normal"
                                          : "0x0" + std::string(1, "0123456789AB"[answer]) + " " +
                                                std::string(name_of(WordKind::exception, answer));
    out += cells({named, numbered(WordKind::result, result), reasons});
  }
  return out;
}

}  // namespace

std::span<const CycleTable> cycle_tables() { return kTables; }

std::string commands_page() {
  std::string out = R"(
## Commands

Register 54 takes a command, register 55 its id. *Done* (result 2) means that the drive has accepted it; where the motion is,
motion_state (32) tells. `axisgate explain result 9` says more of a result.

| command | name | does | needs | done when |
|---|---|---|---|---|
)";
  for (const CommandText& each : kCommands)
    out += cells({std::to_string(static_cast<int>(each.command)), std::string(axisgate::text(each.command)),
                  std::string(each.does), std::string(each.needs), std::string(each.done)});
  out += R"(
**When a command acts.** A *single write* is FC 5, 6 or 22, or FC 15 or 16 with one row. Everything else is a *block*.

- With an id other than 0 only the id decides: an id is new that is neither the last one of this address nor the last one of this
  connection. So what a program scans unchanged starts nothing, whatever others at its address write. Ids are kept 60 s after the
  address's last connection. Where none is kept, the first pair is only remembered: result 10. A program begins by writing command 0
  with an id that it will not use next.
- With id 0, or without register 55, another command than the one remembered is new. The first block of a connection is only
  remembered. A single write acts on an empty memory too, and again after `rearm_ms`, but not when a stop of another client, a fault
  or a loss has ended its last action: then 0 must come first.
- Edge coils are commands without id. Level coils 7, 8 and 9, and coil 0 after a stop or fault, act on 1 only after a 0.
- Stops (2, 3, 4, coils 2 and 3) act if command or id differ from what is remembered, in a single write always.

**What it is answered with.** An exception tells the kind, register 25 the result. A block that is not new is answered normally:
only its result is 10.

)" + outcomes() +
         R"(
**What does not act says so**: result 10; a single write is answered 0x06 as well. Repeating what has acted leaves the result alone.

**Set-points** (41 to 53) are no starts. The one accepted last is what every start uses. In a block, 0 leaves rows 41, 47, 48, 50,
52, 58, 62, 64, 66, 70 and 76 as they are; alone it is refused (0x03). A block of zeros asks for nothing.

**Raw controlwords** (40) follow the rules of a command without id, and in a block on an empty memory are only remembered. A word with
bit 1 or bit 2 at 0 is a stop of any operator; so is one whose bits 0 to 3 are 6 or 7, of a client that does not own the axis in a
single write alone. Going to 0 in a block is a stop. While a stop is latched only stops pass, and the two steps out of it: 6 or 7,
then 15. A CiA 402 drive is sent the word as it is. On iD286pro and Keya bit 4 rising is a start (mode 1: move_absolute, with bit 6
move_relative; mode 6: home), and bit 8 rising a halt; falling they do nothing.
In modes 3, 4, 9 and 10 a word with bits 0 to 3 = 15 runs at the `target_velocity` or `target_torque` accepted since the last motion
ended, else at 0. On an axis that is enabled already one that came in the request of a stop, or from another owner, does not count:
write the target anew, then the word; command 8 takes it as it is.

**Jog.** Coil 8 or 9 at 1 turns the axis at `jog_velocity` as long as its owner writes the 1 again within `jog_timeout_ms` (500);
reads and other writes do not count. It ends by a halt: when the 1 is 0 or too late, with both coils at 1, and at a position limit of
an axis that is homed. Only another 0 to 1 begins anew.

**The stop latch** is set by quick_stop and by a lease's end. Until an enable that is accepted later, commands 6 to 11 and jog are
refused: 0x04, result 9.

**Who may.** A write that asks for something claims the axis for its client (register 28), for the time of its lease (29). Others are
refused then: 0x06, result 7; their stops are not. When the owner falls silent the axis is stopped and latched. While it is disabled
only what asks for something renews the lease. What is refused claims nothing.

| `renew` of the lease | what renews it |
|---|---|
| `any` | any request of the owner; with `"client": "address"` any write |
| `write` | a write to this axis |
| `heartbeat` | a changed number in register 56 of the axis, or 8 of the gateway |

**What nobody holds any more.** When the connection of an owner has ended, its lease goes on until its time is over. A write to this
axis, or a changed number in its register 56, takes it over, of the same address and role and on a connection that was opened after
the owner's last request: nothing happens to the motor then. Writes elsewhere, register 8 too, and programs that were connected
before take nothing over. An axis that the gateway finds enabled
at its start is *adopted*: any operator's write but a block of zeros takes it over; if none comes in the lease's time, the axis is
stopped as its `on_expiry` says.

**Owed stops.** A stop that could not be sent, or was not seen to act, is owed: when the drive is back the stop comes first, and all
but stops and reads is refused: 0x06, result 9.

The next tables are replayed by a test on each drive that has these commands. Each begins with an axis that is disabled and owned by
nobody, with speeds and ramps that are set.
)";
  for (const CycleTable& table : kTables) out += page_of(table);
  return out;
}

}  // namespace axisgate::listing
