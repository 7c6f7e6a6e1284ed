// SPDX-License-Identifier: Apache-2.0
// Nanotec C5-E-2-09: objects, widths and defaults as a public EDS of firmware FIR-v2213 has them; the CL3-E has the
// same.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry nanotec_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},              // store parameters
    {0x6007, 0, i16, rw, eeprom, 1},           // abort connection option code
    {0x603F, 0, u16, ro, ram},                 // error code
    {0x6040, 0, u16, rw, ram},                 // controlword
    {0x6041, 0, u16, ro, ram},                 // statusword
    {0x605A, 0, i16, rw, eeprom, 2},           // quick stop option code
    {0x605B, 0, i16, rw, eeprom, 1},           // shutdown option code
    {0x605C, 0, i16, rw, eeprom, 1},           // disable option code
    {0x605D, 0, i16, rw, eeprom, 1},           // halt option code
    {0x605E, 0, i16, rw, eeprom, 2},           // fault option code
    {0x6060, 0, i8, rw, eeprom},               // modes of operation
    {0x6061, 0, i8, ro, ram},                  // modes of operation display
    {0x6062, 0, i32, ro, ram},                 // position demand
    {0x6063, 0, i32, ro, ram},                 // position actual, internal
    {0x6064, 0, i32, ro, ram},                 // position actual
    {0x6065, 0, u32, rw, eeprom, 256},         // following error window
    {0x6066, 0, u16, rw, eeprom, 100},         // following error time out
    {0x6067, 0, u32, rw, eeprom, 10},          // position window
    {0x6068, 0, u16, rw, eeprom, 100},         // position window time
    {0x606B, 0, i32, ro, ram},                 // velocity demand
    {0x606C, 0, i32, ro, ram},                 // velocity actual
    {0x6071, 0, i16, rw, ram},                 // target torque
    {0x6072, 0, u16, rw, eeprom, 100},         // max torque
    {0x6074, 0, i16, ro, ram},                 // torque demand
    {0x6077, 0, i16, ro, ram},                 // torque actual
    {0x607A, 0, i32, rw, ram, 4000},           // target position
    {0x607C, 0, i32, rw, eeprom},              // home offset
    {0x607D, 1, i32, rw, eeprom},              // position limit, minimum
    {0x607D, 2, i32, rw, eeprom},              // position limit, maximum
    {0x607E, 0, u8, rw, eeprom},               // polarity
    {0x607F, 0, u32, rw, eeprom, 30000},       // max profile velocity
    {0x6080, 0, u32, rw, eeprom, 30000},       // max motor speed
    {0x6081, 0, u32, rw, eeprom, 500},         // profile velocity
    {0x6083, 0, u32, rw, eeprom, 500},         // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 500},         // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 5000},        // quick stop deceleration
    {0x608F, 1, i32, rw, eeprom, 4096},        // encoder increments
    {0x608F, 2, i32, rw, eeprom, 1},           // motor revolutions
    {0x6091, 1, u32, rw, eeprom, 1},           // gear ratio: motor revolutions
    {0x6091, 2, u32, rw, eeprom, 1},           // gear ratio: shaft revolutions
    {0x6092, 1, u32, rw, eeprom, 1},           // feed constant: feed
    {0x6092, 2, u32, rw, eeprom, 1},           // feed constant: shaft revolutions
    {0x6098, 0, i8, rw, eeprom, 35},           // homing method
    {0x6099, 1, u32, rw, eeprom, 50},          // speed during search for switch
    {0x6099, 2, u32, rw, eeprom, 10},          // speed during search for zero
    {0x609A, 0, u32, rw, eeprom, 500},         // homing acceleration
    {0x60A8, 0, u32, rw, eeprom, 0xFF410000},  // SI unit position: tenths of a degree
    {0x60A9, 0, u32, rw, eeprom, 0x00B44700},  // SI unit velocity: rpm
    {0x60F4, 0, i32, ro, ram},                 // following error
    {0x60FD, 0, u32, ro, ram},                 // digital inputs
    {0x60FF, 0, i32, rw, ram},                 // target velocity
    {0x6502, 0, u32, ro, ram, 0x3EF},          // supported drive modes
};

// Positions and speeds are those of the shaft behind the gear (6091h); 60A8h says in what a position is counted.
EdsUnits nanotec_units(const ObjectDictionary& of, std::int64_t counts) {
  constexpr std::int64_t tenths_of_degree = 0xFF410000, tenths = 3600;
  const EdsUnit gear = EdsUnit{of.get({0x6091, 2}), of.get({0x6091, 1})}.reduced();
  const std::int64_t per_turn = of.get({0x60A8, 0}) == tenths_of_degree ? tenths : counts;
  return {{per_turn * gear.of, gear.per}, {60 * gear.of, gear.per}, {60 * gear.of, gear.per}};
}

}  // namespace

constinit const EdsDriveType nanotec_type{
    .name = "nanotec-c5-e",
    .device_name = "C5-E-2-09",
    .identity = {0x0000026C, 0x00000011, 0x08A50000, 1},
    .device_type = 0x00060192,
    .objects = nanotec_objects,
    .encoder_counts = 4096,
    .units = nanotec_units,
    .guarding = true,
};

}  // namespace axisgate::simulated
