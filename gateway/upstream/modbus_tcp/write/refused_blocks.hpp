// SPDX-License-Identifier: Apache-2.0
// What a client is answered to its block writes that are refused with 0x01, 0x02 or 0x03 (design 3.3 Refused blocks):
// where, in command_detail, and once in the log. Promises that a command of this client that is pending keeps its
// registers, and that a scanner that repeats its block writes one line. Never decides whether a write is refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/error.hpp"
#include "gateway/core/log.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

/// command_detail of a refused block: this, and the offset of the first row refused.
inline constexpr std::uint32_t kDetailRow = 0x0A000000;
[[nodiscard]] constexpr std::uint32_t row_detail(std::uint16_t row) { return kDetailRow + row; }

/// The request itself was wrong: 0x01, 0x02 and 0x03.
[[nodiscard]] bool is_wrong(Errc code);

/// Registers, or coils, of one request; for the log.
struct BlockWrite {
  AxisNumber axis = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;
  bool coils = false;
  std::string limit{};  ///< of a row refused by one: "3 rpm"
};
[[nodiscard]] BlockWrite block_write(const Request& request, AxisNumber axis);

/// Registers 25 to 27, where no command of the client is pending. True: they tell of this block now.
bool show_refused(ClientAxis& axis, std::uint16_t row);
/// Who, what and why: once, until the row or the reason differs or a block of this client to this axis has succeeded.
void log_refused(const BlockWrite& block, const RefusedRow& refused, Client& client, const Log& log);
void note_block_done(ClientAxis& axis);
/// The same of a write that is no block, or for no axis (`write.axis` 0): once a minute while a client repeats it.
void log_refused_write(const BlockWrite& write, const Outcome& outcome, Client& client, Instant now, const Log& log);
/// The same of a write by 43/13.
void log_refused_object(const GeneralReference& reference, const Outcome& outcome, Client& client, Instant now,
                        const Log& log);
/// A lone half of this row is dropped: result 6 with the row as detail, as above, and once in the log.
void tell_dropped_half(AxisNumber axis, std::uint16_t row, const char* why, Client& client, const Log& log);
/// Both halves of a row have come: the next one that comes alone is answered again.
void note_whole_row(ClientAxis& axis);
/// The coil that asks for this command, of a write batch that coils have asked for.
[[nodiscard]] std::uint16_t coil_of(Command command);

}  // namespace axisgate::modbus_tcp
