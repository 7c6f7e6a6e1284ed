// SPDX-License-Identifier: Apache-2.0
#include "gateway/listing/map_page.hpp"

#include "gateway/image/register_map.hpp"
#include "gateway/listing/commands_page.hpp"
#include "gateway/listing/map_listing.hpp"
#include "gateway/listing/row_meanings.hpp"

namespace axisgate::listing {
namespace {

using namespace std::string_literals;

std::string cell(std::string_view text) { return " " + std::string(text) + " |"; }

std::string role_of_writer(const RegisterRow& row) {
  if (!row.writable) return "";
  return std::string(text(row.may_write));
}

std::string bit_of(const RegisterRow& row) {
  return row.source == Source::quantity ? std::to_string(static_cast<unsigned>(row.quantity)) : ""s;
}

/// "where the motor is", and behind it what its note adds.
std::string meaning(std::string_view words, std::string_view note) {
  return std::string(words) + (note.empty() ? "" : ": ") + std::string(note);
}

/// Of the first block of its kind: axis 1, bus 0.
std::string reference(std::string_view table, Block block, std::uint16_t offset) {
  MapEntry entry;
  entry.table = table;
  entry.address = static_cast<std::uint16_t>(address_of(block, block == Block::bus ? 0 : 1) + offset);
  if (block == Block::gateway) entry.address = offset;
  return reference_of(entry);
}

std::string registers(Block block) {
  const std::string_view first = block == Block::gateway ? "from 40001"
                                 : block == Block::bus   ? "bus 0 from 40001"
                                                         : "axis 1 from 40001";
  std::string out = "| offset | name | type | access | unit | bit | may write |" + cell(first) +
                    " meaning |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const RegisterRow& row : register_table(block).rows()) {
    out += "|" + cell(std::to_string(row.offset)) + cell(row.name) + cell(text(row.type)) +
           cell(row.writable ? "rw" : "r") + cell(unit_of(row, "1/units_per_rev rev")) + cell(bit_of(row)) +
           cell(role_of_writer(row)) + cell(reference("holding", block, row.offset)) +
           cell(meaning(register_meaning(block, row.name), row.note)) + "\n";
  }
  return out;
}

std::string coils() {
  std::string out =
      "| offset | name | kind | 1 asks for | 0 asks for | axis 1 from 00001 | meaning "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const CoilRow& coil : coil_rows()) {
    const auto asks = [&](Command command) { return command == Command::none ? std::string_view{} : text(command); };
    out += "|" + cell(std::to_string(coil.offset)) + cell(coil.name) + cell(coil.level ? "level" : "edge") +
           cell(asks(coil.on)) + cell(asks(coil.off)) + cell(reference("coil", Block::axis, coil.offset)) +
           cell(meaning(coil_meaning(coil.name), coil.note)) + "\n";
  }
  return out;
}

std::string inputs() {
  std::string out = "| offset | name | axis 1 from 10001 | meaning |\n|---|---|---|---|\n";
  for (const InputRow& input : input_rows())
    out += "|" + cell(std::to_string(input.offset)) + cell(input.name) +
           cell(reference("discrete", Block::axis, input.offset)) +
           cell(meaning(input_meaning(input.name), input.note)) + "\n";
  return out;
}

}  // namespace

std::string register_map_page() {
  return R"(# Modbus-TCP register map, version )" + std::to_string(kMapVersion) + R"(

Made from the table that the server answers from. `axisgate map CONFIG` prints the addresses of one configuration.

Holding registers (FC 3, 6, 16, 22, 23) and input registers (FC 4) show the same table at the same addresses. Addresses
count from 0; what counts from 40001 (input registers from 30001, coils from 00001, inputs from 10001) adds 1, and has a digit
more above 9999: register 10000 is 410001. 32-bit values take two registers, high word first, or low word first
with the listener option `"word_order": "low-first"`; register 10 of the gateway block tells which. *bit* is the number of
the quantity in `supported` and `valid`.

A read may begin or end inside a 32-bit value; a write of half of one is refused (0x02), but for panels (below). Offsets that are not listed read 0.
In a longer write they are ignored from 40 to 89, else refused. Addresses outside every block, and blocks of axes or buses
that are not configured, are refused (0x02). A value never received, not supported or not representable reads as the end of
its type: i16 -32768, u16 65535, i32 -2147483648, u32 4294967295; as a setpoint that number is refused (0x03).

A block write (more than one row in a request, and every FC 23) that is refused with 0x01, 0x02 or 0x03 tells in
`command_detail` which row it was: 0x0A000000 + the offset of the first one that the answer is about; of FC 15 the coil's
offset. Not while a command of the same client is pending.

Device identification (FC 43, MEI 14) has beside the usual objects 0x80 the number of axes, 0x81 the version of this map, 0x82 the
word order, 0x83 the unit ids, 0x84 the numbers, 0x85 the halves, and from 0x90 on what the axes are called: lines `3 lift`, by number.

## Panels

With the listener option `"numbers": "float"` the 32-bit rows of positions, velocities and accelerations (offsets 2, 4, 8, 42,
44, 48, 50, 52, 58 and 62 to 78; 2 and 4 of the overview) are IEEE 754 numbers in turns, rpm and rpm/s, at the same offsets and
in the listener's word order; all other rows are as below. Where there is no value they read NaN (0x7FC00000). A written number
is rounded once, half away from zero, to the unit of the row; NaN, an infinite number, one beyond the row's range, and one
that would round to the 0 that leaves a row as it is, are refused (0x03). Minus zero is 0. A number has 24 bits: with 10000 units a
turn each 1/10000 turn has a number of its own up to 1024 turns; at 1677 turns the numbers are 0.00012 turn apart.
`axisgate check` says it for each axis.

With `"halves": "staged"`, for panels that only have FC 6, a 32-bit row is written in two requests: either half first, then the other,
on the same connection, with no other write between. The first half is answered, and checked for role and address; the row
is written, as one single write, with the second one, and its answer is the row's. Until then the row reads its old value.
A half whose other half has not come within 1 s, or before another write, is dropped: result 6, detail 0x0A000000 + the row's
offset, a line in the log. A half of FC 16 or FC 22 is refused on every listener, and counts as another write.

## Axis n: registers from 100 * n

A cyclic scanner reads 0..38 and writes 40..56.

)" + registers(Block::axis) +
         R"(
## Axis n: coils (FC 1, 5, 15) from 100 * n

Level coils act on both changes and read the axis's state; edge coils act on 0 to 1 and read 0. 10..15 are reserved: a 0 is
accepted, a 1 is refused (0x02).

)" + coils() +
         R"(
## Axis n: discrete inputs (FC 2) from 100 * n

)" + inputs() +
         R"(
## Overview of axis n: registers from 60000 + 10 * n

Twelve axes in one request. Between configured axes a missing number reads 0.

)" + registers(Block::overview) +
         R"(
## Gateway: registers from 0

)" + registers(Block::gateway) +
         R"(
## Bus b: registers from 50000 + 100 * b

Buses count from 0 in the order of the configuration.

)" + registers(Block::bus) +
         commands_page();
}

}  // namespace axisgate::listing
