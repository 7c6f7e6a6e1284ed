// SPDX-License-Identifier: Apache-2.0
// What the numbers that axisgate shows are called, what each means, what usually causes it and what to do.
// Promises one table: `top`, `topics`, the log, events, the register map's page, `axisgate explain`,
// docs/troubleshooting.md and docs/glossary.md read it, so that a state has one name everywhere. Numbers of one kind
// are unique and rising.
// Never says what a drive's own fault codes mean: that is in the drive profiles.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/error.hpp"

namespace axisgate {

enum class WordKind : std::uint8_t {
  axis_state,     ///< register 31
  motion_state,   ///< register 32
  link_state,     ///< register 18
  mode,           ///< registers 1 and 41 (CiA 402-2 table 83)
  axis_alarm,     ///< bits of registers 34, 35
  gateway_state,  ///< register 2 of the gateway block
  gateway_alarm,  ///< bits of register 6 of the gateway block
  result,         ///< register 25; DDS: `result` of a reply
  exception,      ///< Modbus application protocol V1.1b3 section 7
  abort_code,     ///< CiA 301 table 22: in command_detail
  error_code,     ///< register 10: classes of CiA 301 table 26 and CiA 402-2; the drive's own texts are in its profile
  block_error,    ///< ErrorID of the blocks for PLCs (deploy/plc/axisgate.st), but for those that are results
  term,           ///< a word of the manual that one must know before the first enable; its number only orders it
};
inline constexpr int kWordKinds = static_cast<int>(WordKind::term) + 1;
/// ErrorIDs of a row that was refused: this and its offset.
inline constexpr std::uint32_t kRefusedRowError = 0x0100, kRefusedRowErrorLast = kRefusedRowError + 0xFF;
/// Results above are of DDS replies alone: no register and no ErrorID has them.
inline constexpr std::uint32_t kFirstResultOfDds = 16;

struct Word {
  WordKind kind{};
  std::uint32_t number = 0;  ///< of alarms: the bit
  std::string_view name;
  std::string_view meaning;
  std::string_view causes;  ///< empty: it is no trouble; of a term: what is seen of it
  std::string_view remedy;
  bool refuses_enable = false;  ///< of axis alarms
};

/// By kind, then by number.
[[nodiscard]] std::span<const Word> words();
/// Null: there is none.
[[nodiscard]] const Word* find_word(WordKind kind, std::uint32_t number);
/// An error_code by itself, else by its class: 0x2310, 0x2300, 0x2000. Null: of no class; 0: no error.
[[nodiscard]] const Word* find_error(std::uint16_t code);
/// Its name; "?" where there is none.
[[nodiscard]] std::string_view name_of(WordKind kind, std::uint32_t number);
/// Names of the bits that are set, with ", " between; a bit without a name as "bit 17"; empty: none is set.
[[nodiscard]] std::string names_of_bits(WordKind kind, std::uint32_t bits);
/// What helps, where the word is met at this axis: "axisgate commission CONFIG 3 shows and changes it".
[[nodiscard]] std::string remedy_for(const Word& word, unsigned axis);
/// What of these bits of register 34 stands against an enable, and what helps: "alarm local_control: the drive obeys
/// its own inputs or keypad and ignores the bus; axisgate commission CONFIG 3 shows and changes it". Empty: nothing.
[[nodiscard]] std::string against_enable(std::uint32_t axis_alarms, unsigned axis);
/// Register 31 in a word: "latched" where a stop is latched and the axis stands, else the name of the number.
[[nodiscard]] std::string_view axis_state_text(std::uint32_t state, bool latched_and_stands);
/// All of a kind as a register's meaning tells them: "0 none, 1 active, 2 completed", of alarms "bit 0 not_homed, 1
/// ..."; of results those that a register shows.
[[nodiscard]] std::string list_of(WordKind kind);
/// How a request ended, as its client has seen it: "value outside limits (exception 0x03 illegal data value)", "refused
/// by the drive (exception 0x04 server device failure, result 3 refused by drive, detail 0x06010002 read only)".
[[nodiscard]] std::string modbus_text(const Outcome& outcome);
/// The same for a DDS writer: "value outside limits (result 17 bad value (DDS))".
[[nodiscard]] std::string dds_text(const Outcome& outcome);
/// As it is usually written: "7", "0x06010002", "0x3130", "16#0208"; a term has none.
[[nodiscard]] std::string number_text(const Word& word);
/// "axis state"
[[nodiscard]] std::string_view title(WordKind kind);
/// "31": where a client reads it; empty where it stands in no register.
[[nodiscard]] std::string_view place(WordKind kind);

/// What somebody who saw it might type: a name ("stop_latched", "Stop latched"), a kind and a number ("result 9"), a
/// number alone ("9": of every kind that has it), an abort code ("0x06010002"), an ErrorID ("16#0208"). Empty: nothing
/// is called so.
[[nodiscard]] std::vector<const Word*> look_up(std::string_view typed);
/// A number as typed, decimal, 0x or 16#; none: it is no number, or above 32 bits.
[[nodiscard]] std::optional<std::uint32_t> typed_number(std::string_view typed);

/// The page docs/troubleshooting.md.
[[nodiscard]] std::string troubleshooting_page();
/// The page docs/glossary.md: the terms.
[[nodiscard]] std::string glossary_page();

}  // namespace axisgate
