// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/refused_blocks.hpp"

#include <array>
#include <string>

#include "gateway/core/words.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {
namespace {

/// ", target_position"; empty where no row or coil is listed there.
std::string named(const BlockWrite& block, std::uint16_t offset) {
  if (block.coils) return offset < kCoils ? ", " + std::string(coil_rows()[offset].name) : "";
  const RegisterRow* const row = register_table(Block::axis).covering(offset);
  const std::string limit = block.limit.empty() ? std::string() : " (its limit is " + block.limit + ")";
  return row == nullptr ? "" : ", " + std::string(row->name) + limit;
}

/// Why an address is not to be written so. Empty: it is one, and the drive has no such thing.
std::string address_fault(const BlockWrite& block, std::uint16_t offset) {
  if (block.coils) return offset < kCoils ? "" : "there is no such coil";
  const RegisterRow* const row = register_table(block.axis == 0 ? Block::gateway : Block::axis).covering(offset);
  if (row == nullptr) return "there is no such row";
  if (!row->writable) return "it is read only";
  const std::uint16_t first = block.address % kAxisBlock;
  if (row->offset < first) return "the write begins with its second half: both halves go in one request";
  if (row->offset + row->registers() > first + block.count)
    return "the write ends with its first half: both halves go in one request";
  return {};
}

/// Each refusal says its own reason.
std::string why_refused(const BlockWrite& block, std::uint16_t offset, const Outcome& outcome, bool in_full) {
  const std::string general(in_full ? modbus_text(outcome) : std::string(text(outcome.code)));
  const std::string own = outcome.code == Errc::not_supported ? address_fault(block, offset) : std::string();
  return own.empty() ? general : own + general.substr(text(outcome.code).size());
}

/// A tool in a loop must not fill the log.
constexpr Duration kToldAgain = std::chrono::seconds(60);

/// @param axis 0: of none
LogSource speaks_of(AxisNumber axis) { return {.words = "modbus", .axis = axis}; }

void log_once(const RefusedWrite& refused, AxisNumber axis, const std::string& what, const std::string& why,
              Client& client, Instant now, const Log& log) {
  if (client.refused == refused && now - client.refusal_logged_at < kToldAgain) return;
  if (!client.host->refused_lines.takes(now)) return;
  client.refused = refused;
  client.refusal_logged_at = now;
  log.write(
      LogLevel::info, speaks_of(axis),
      client.life->name + ": " + what + " is refused: " + why + left_out_text(client.host->refused_lines.left_out()));
}

}  // namespace

bool is_wrong(Errc code) {
  return code == Errc::bad_value || code == Errc::not_supported || code == Errc::role_forbidden;
}

BlockWrite block_write(const Request& request, AxisNumber axis) {
  return {axis, request.write_address, request.write_count, request.writes_coils()};
}

bool show_refused(ClientAxis& axis, std::uint16_t row) {
  if (axis.result.result == CommandResult::pending) return false;
  axis.used = true;
  axis.result = {CommandResult::none, row_detail(row), 0};
  ++axis.submission;
  return true;
}

void log_refused(const BlockWrite& block, const RefusedRow& refused, Client& client, const Log& log) {
  ClientAxis& axis = client.at(block.axis);
  if (axis.refused == refused) return;
  axis.refused = refused;
  const std::string what = block.coils ? "coil" : "row";
  log.write(LogLevel::info, speaks_of(block.axis),
            client.life->name + ": a block write of " + std::to_string(block.count) +
                (block.coils ? " coils from " : " registers from ") + std::to_string(block.address) +
                " is refused at " + what + " " + std::to_string(refused.offset) + " of axis " +
                std::to_string(block.axis) + named(block, refused.offset) + ": " +
                why_refused(block, refused.offset, {refused.why}, false));
}

void log_refused_write(const BlockWrite& write, const Outcome& outcome, Client& client, Instant now, const Log& log) {
  const std::uint16_t offset = write.address % kAxisBlock;
  const std::string where =
      write.axis == 0 ? std::string() : " of axis " + std::to_string(write.axis) + named(write, offset);
  const std::string kind = write.coils ? "coil " : "register ";
  log_once({write.address, write.coils, outcome.code}, write.axis,
           "a write to " + kind + std::to_string(write.address) + where,
           why_refused(write, write.axis == 0 ? write.address : offset, outcome, true), client, now, log);
}

void log_refused_object(const GeneralReference& reference, const Outcome& outcome, Client& client, Instant now,
                        const Log& log) {
  const std::array<Byte, 2> index{static_cast<Byte>(reference.index >> 8U), static_cast<Byte>(reference.index)};
  const std::array<Byte, 1> sub{reference.subindex};
  std::string digits = hex_text(index);
  std::erase(digits, ' ');
  log_once({reference.index, false, outcome.code}, 0,
           "a write of object 0x" + digits + ":" + hex_text(sub) + " (43/13)", modbus_text(outcome), client, now, log);
}

void tell_dropped_half(AxisNumber axis, std::uint16_t row, const char* why, Client& client, const Log& log) {
  ClientAxis& own = client.at(axis);
  if (show_refused(own, row)) own.result.result = CommandResult::never_started;
  const RefusedRow dropped{row, Errc::never_started};
  if (own.refused == dropped) return;
  own.refused = dropped;
  log.write(LogLevel::info, speaks_of(axis),
            client.life->name + ": half of row " + std::to_string(row) + " of axis " + std::to_string(axis) +
                named({.axis = axis}, row) + ", was written and is dropped: " + why);
}

void note_whole_row(ClientAxis& axis) {
  if (axis.refused && axis.refused->why == Errc::never_started) axis.refused.reset();
}

void note_block_done(ClientAxis& axis) { axis.refused.reset(); }

std::uint16_t coil_of(Command command) {
  for (const CoilRow& coil : coil_rows())
    if (command != Command::none && (coil.on == command || coil.off == command)) return coil.offset;
  return 0;
}

}  // namespace axisgate::modbus_tcp
