// SPDX-License-Identifier: Apache-2.0
// Trinamic TMCM-1270: objects, widths and defaults as a public EDS has them; where it has none, plausible numbers.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry trinamic_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},               // save all parameters
    {0x2000, 0, u8, rw, eeprom, 8},             // microstep resolution
    {0x2001, 0, u16, rw, eeprom, 200},          // fullstep resolution
    {0x2107, 0, u8, ro, ram, 8},                // microstep resolution display
    {0x6040, 0, u16, rw, ram},                  // controlword
    {0x6041, 0, u16, ro, ram},                  // statusword
    {0x605A, 0, i16, rw, eeprom, 2},            // quick stop option code
    {0x605B, 0, i16, ro, ram},                  // shutdown option code
    {0x605C, 0, i16, ro, ram, 1},               // disable operation option code
    {0x605D, 0, i16, rw, eeprom, 1},            // halt option code
    {0x605E, 0, i16, ro, ram, 2},               // fault reaction option code
    {0x6060, 0, i8, rw, ram},                   // modes of operation
    {0x6061, 0, i8, ro, ram},                   // modes of operation display
    {0x6062, 0, i32, ro, ram},                  // position demand value
    {0x6063, 0, i32, ro, ram},                  // position actual internal value
    {0x6064, 0, i32, ro, ram},                  // position actual value
    {0x6065, 0, u32, rw, eeprom},               // following error window
    {0x6067, 0, u32, rw, eeprom, 4294967295},   // position window
    {0x606C, 0, i32, ro, ram},                  // velocity actual value
    {0x607A, 0, i32, rw, ram},                  // target position
    {0x607C, 0, i32, rw, eeprom},               // home offset
    {0x607D, 1, i32, rw, eeprom, -2147483648},  // min software position limit
    {0x607D, 2, i32, rw, eeprom, 2147483647},   // max software position limit
    {0x6081, 0, u32, rw, eeprom, 51200},        // profile velocity in pp-mode
    {0x6083, 0, u32, rw, eeprom, 51200},        // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 51200},        // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 51200},        // quick stop deceleration
    {0x608F, 1, u32, rw, eeprom, 51200},        // encoder increments
    {0x608F, 2, u32, ro, ram, 1},               // motor revolutions
    {0x6098, 0, i8, rw, eeprom},                // homing method
    {0x6099, 1, u32, rw, eeprom, 25600},        // fast homing speed
    {0x6099, 2, u32, rw, eeprom, 5120},         // slow homing speed
    {0x609A, 0, u32, rw, eeprom, 51200},        // homing acceleration
    {0x60FD, 0, u32, ro, ram},                  // digital inputs
    {0x60FF, 0, i32, rw, ram},                  // target velocity
    {0x6502, 0, u32, ro, ram, 0xa5},            // supported drive modes
};

constexpr ObjectKey trinamic_unmappable[] = {
    {0x605A, 0}, {0x605B, 0}, {0x605C, 0}, {0x605D, 0}, {0x605E, 0}, {0x6065, 0}, {0x6067, 0},
    {0x607C, 0}, {0x607D, 1}, {0x607D, 2}, {0x6081, 0}, {0x6083, 0}, {0x6084, 0}, {0x6085, 0},
    {0x608F, 1}, {0x608F, 2}, {0x6098, 0}, {0x6099, 1}, {0x6099, 2}, {0x609A, 0}, {0x6502, 0}};

// Microsteps: 200 full steps of 256, as 2001h and 2000h say; per second and per second squared.
EdsUnits trinamic_units(const ObjectDictionary&, std::int64_t counts) { return counts_of_encoder(counts); }

}  // namespace

constinit const EdsDriveType trinamic_type{
    .name = "trinamic-tmcm-1270",
    .device_name = "TMCM-1270",
    .identity = {0x00000286, 0x000004F6, 0x00030018, 1},
    .device_type = 0xFFFF0192,
    .objects = trinamic_objects,
    .unmappable = trinamic_unmappable,
    .encoder_counts = 51200,
    .units = trinamic_units,
    .tells_counts = false,
    .guarding = true,
};

}  // namespace axisgate::simulated
