// SPDX-License-Identifier: Apache-2.0
// What clients, cables and drives do in one judged run, as plain data: drawn from a seed, shrunk and printed. Promises
// that a step means the same whatever stands before it is taken out: values, ids and words are told relative to what
// the same client wrote last. Never knows what a step will lead to.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/judged/nemesis.hpp"
#include "tests/model/write.hpp"
#include "tests/stage/subject.hpp"

namespace axisgate::test::judged {

/// What a run is about: a raw mode belongs to moves or to speeds.
enum class Flavour : std::uint8_t { moves, speeds, both };

enum class Deed : std::uint8_t {
  wait,
  command,        ///< row 54 alone
  command_by_id,  ///< 54 and 55
  order,          ///< targets and command, 42 to 55
  image,          ///< the whole of a scanner's block, 40 to 56
  zeros,          ///< the same before its program runs
  target,         ///< one target alone
  parameter,      ///< one row of 46, 47 and 62 to 76
  mode_block,     ///< 41 to 43
  word_block,     ///< 40 to 45
  word,           ///< controlword alone
  coil,           ///< one coil
  start_coils,    ///< coils 4 to 7 in one request
  cross,          ///< commands and stops of one client or of each in turn, none of which waits for an answer
  again,          ///< what this client wrote last, once more
  scan,           ///< the same each 50 ms
  button,         ///< a jog button is pressed and held, written each 200 ms, and released or forgotten; or both are
  tool,           ///< a target and a press of its start, again and again; a connection for each, or one for all
  monitor,        ///< one that only reads, each 100 ms
  insist,         ///< what was answered 0x06 or 0x0B is asked once more, until it is answered otherwise
  rival,          ///< another client takes the axis while it moves
  read,           ///< registers 0 to 38
  object,         ///< the mailbox, or 43/13, writes the drive's own position target
  look_up,        ///< 43/13 reads an object of the drive
  halves,         ///< one target by two writes of function 6, sometimes with another write between
  bystander,      ///< a viewer writes
  sample,         ///< of a DDS writer
  once_more,      ///< one of its last ones with the same request_id, perhaps after another gateway was asked
  new_writer,     ///< it is deleted, or its liveliness is lost, and another one begins
  masters,        ///< a DDS master is alive in one way or another, or is not, and another one comes
  dds_dies,       ///< the process, and comes back
  dds_jog,        ///< a jog by samples, held and let go or forgotten
  release,        ///< command 13
  reconnect,      ///< the connection ends, a new one begins; perhaps of a PLC that was started anew, ids and all
  vanish,         ///< silent for ever; a new connection begins after a while
  lost,           ///< something is pressed, or let go, while the drive is out of sight
  cut,            ///< the wire, and nobody reports it; or the drive heeds no quick stop, and shows it all the same
  unplug,         ///< the adapter, and the system reports it
  lose,           ///< the next answers of the drive
  late,           ///< they come late
  twice,          ///< they come twice
  restart,        ///< the drive's power
  trip,           ///< the drive has a fault
  crash,          ///< the gateway dies and is started again
  other_master,   ///< on the CAN bus somebody else commands the drive, or begins its communication anew
};

struct Step {
  Deed deed = Deed::wait;
  std::uint8_t client = 0;
  std::uint8_t command = 0;   ///< of kCommands
  std::uint8_t id = 0;        ///< 0: none, 1: as before, else the next
  std::uint8_t position = 0;  ///< of kPositions; the last one: as before
  std::uint8_t speed = 0;     ///< the same, of kSpeeds
  std::uint8_t number = 0;    ///< of a coil, a word, a function code: as the deed takes it
  bool on = false;
  bool at_once = false;     ///< what follows does not wait for the answer
  std::uint8_t length = 0;  ///< of kLengths: an outage, a scan, a held button
  std::uint8_t pause = 0;   ///< of kPauses, afterwards
};

struct Program {
  Subject subject = Subject::jd_serial;
  Flavour flavour = Flavour::moves;
  bool leases = false;
  std::vector<Step> steps{};
  Nemesis nemesis{};
};

// Few of them, so that what was written before is written again.
inline constexpr std::array<std::int64_t, 4> kPositions{1'000, -20'000, 150'000, -500'000};
inline constexpr std::array<std::int64_t, 4> kSpeeds{60'000, -120'000, 150'000, 0};
inline constexpr std::array<std::int64_t, 17> kCommands{0, 1, 1, 6, 6, 6, 8, 7, 3, 4, 2, 5, 9, 10, 11, 14, 12};
inline constexpr std::array<std::int64_t, 7> kPauses{0, 0, 50, 50, 300, 1200, 2500};
inline constexpr std::array<std::int64_t, 8> kLengths{1, 20, 100, 300, 700, 1500, 4000, 12'000};

/// How hard the plant is to its gateway.
enum class Weather : std::uint8_t { calm, rough };

/// Of the seed alone.
[[nodiscard]] Program draw(Subject subject, Weather weather, bool leases, std::uint64_t seed);
[[nodiscard]] std::string text(const Step& step);

}  // namespace axisgate::test::judged
