// SPDX-License-Identifier: Apache-2.0
// What is known of a CiA 402 drive on CANopen from its maker's EDS, as one row of facts: objects, numbers and what they
// count, what it does where CiA 402 leaves a choice. Promises plain data, of the public files that docs/drives names,
// never of a profile. Never holds a value of a running drive.
#pragma once

#include <array>
#include <numeric>
#include <span>
#include <string_view>

#include "tests/simulated/object_dictionary.hpp"

namespace axisgate::simulated {

// How many of the drive's units are one: of a turn, of a turn a second, of a turn a second squared. A fraction.
struct EdsUnit {
  std::int64_t of = 1;
  std::int64_t per = 1;

  constexpr EdsUnit reduced() const {
    const std::int64_t common = std::gcd(of, per);
    return {of / common, per / common};
  }
};

struct EdsUnits {
  EdsUnit position;
  EdsUnit speed;
  EdsUnit acceleration;
};

// Units that are counts of the encoder, per second and per second squared.
constexpr EdsUnits counts_of_encoder(std::int64_t counts) { return {{counts}, {counts}, {counts}}; }

// What delivers its position in counts, its speed in rpm and its ramps in rpm/s.
constexpr EdsUnits counts_and_rpm(std::int64_t counts) { return {{counts}, {60}, {60}}; }

struct EdsDriveType {
  std::string_view name;         // as axisgate-sim and the tests call it: the name of its profile
  std::string_view device_name;  // 1008h
  std::array<std::uint32_t, 4> identity;
  std::uint32_t device_type;
  std::span<const ObjectEntry> objects;     // from 2000h on, and 1010h
  std::span<const ObjectKey> unmappable{};  // of those from 6000h on
  std::span<const std::int8_t> homing{};    // the methods it has; none listed: those of CiA 402
  std::int64_t encoder_counts;              // of the motor on the bench, a turn
  EdsUnits (*units)(const ObjectDictionary& objects, std::int64_t encoder_counts);

  bool real_speeds = false;  // speeds and ramps are REAL32, and `units` those of their thousandths
  bool tells_counts = true;  // by an object: how many a turn has. Else a configuration must say it

  // CiA 301
  int consumers = 1;             // entries of 1016h; 0: there is none
  bool guarding = false;         // 100Ch and 100Dh
  bool inhibit_time = true;      // sub 3 of a TPDO
  bool event_timer = true;       // sub 5 of a TPDO
  std::uint8_t mapped_most = 8;  // entries of a mapping

  // CiA 402, where the object that says it is missing
  std::int64_t quick_stop = 2;      // as 605Ah has it
  std::int64_t shutdown = 0;        // as 605Bh
  std::int64_t disable = 1;         // as 605Ch
  std::int64_t fault_reaction = 2;  // as 605Eh
  std::int64_t master_lost = 1;     // as 6007h: 0 nothing, 1 a fault, 2 disable voltage, 3 a quick stop
  std::int64_t torque_mode = 4;     // 10 where it has the cyclic one alone
};

std::span<const EdsDriveType* const> eds_drive_types();
// Nothing where none is called so.
const EdsDriveType* eds_drive_type(std::string_view name);

}  // namespace axisgate::simulated
