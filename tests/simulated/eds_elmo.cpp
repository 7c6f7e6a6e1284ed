// SPDX-License-Identifier: Apache-2.0
// Elmo Gold and SimplIQ: objects, widths, defaults and limits as public DCF files have them.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry gold_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},                // save all parameters
    {0x6007, 0, i16, rw, eeprom, 1, 0, 3},       // abort connection option code
    {0x603F, 0, u16, ro, ram},                   // error code
    {0x6040, 0, u16, rw, ram},                   // controlword
    {0x6041, 0, u16, ro, ram},                   // statusword
    {0x605A, 0, i16, rw, eeprom, 2, -32768, 8},  // quick stop option code
    {0x605B, 0, i16, rw, eeprom, 0, 0, 1},       // shutdown option code
    {0x605C, 0, i16, rw, eeprom, 0, 0, 1},       // disable operation option code
    {0x605D, 0, i16, rw, eeprom, 2, 1, 2},       // halt option code
    {0x605E, 0, i16, rw, eeprom, 2, 0, 2},       // fault reaction option code
    {0x6060, 0, i8, rw, ram, 0, -128, 10},       // modes of operation
    {0x6061, 0, i8, ro, ram, 0, 0, 10},          // modes of operation display
    {0x6062, 0, i32, ro, ram},                   // position demand value
    {0x6063, 0, i32, ro, ram},                   // position actual internal value
    {0x6064, 0, i32, ro, ram},                   // position actual value
    {0x6065, 0, u32, rw, eeprom},                // following error window
    {0x6067, 0, u32, rw, eeprom, 100},           // position window
    {0x606B, 0, i32, ro, ram},                   // velocity demand value
    {0x606C, 0, i32, ro, ram},                   // velocity actual value
    {0x6071, 0, i16, rw, ram},                   // target torque
    {0x6072, 0, u16, rw, eeprom, 50000},         // max torque
    {0x6074, 0, i16, ro, ram},                   // torque demand
    {0x6077, 0, i16, ro, ram},                   // torque actual value
    {0x6078, 0, i16, ro, ram},                   // current actual value
    {0x6079, 0, u32, ro, ram},                   // dc link circuit voltage
    {0x607A, 0, i32, rw, ram},                   // target position
    {0x607C, 0, i32, rw, eeprom},                // home offset
    {0x607D, 1, i32, rw, eeprom, -900000000},    // software position limit min
    {0x607D, 2, i32, rw, eeprom, 900000000},     // software position limit max
    {0x607F, 0, u32, rw, eeprom, 2000000000},    // max profile velocity
    {0x6080, 0, u32, rw, eeprom, 4294967295},    // max motor speed
    {0x6081, 0, u32, rw, eeprom, 2000000000},    // profile velocity
    {0x6083, 0, u32, rw, eeprom, 2000000000},    // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 2000000000},    // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 2000000000},    // quick stop deceleration
    {0x608F, 1, u32, rw, eeprom, 1},             // encoder increments
    {0x608F, 2, u32, rw, eeprom, 1},             // motor revolutions
    {0x6098, 0, i8, rw, eeprom, 0, -128, 35},    // homing method
    {0x6099, 1, u32, rw, eeprom},                // homing speeds speed during search for switch
    {0x6099, 2, u32, rw, eeprom},                // homing speeds speed during search for zero
    {0x609A, 0, u32, rw, eeprom},                // homing acceleration
    {0x60F4, 0, i32, ro, ram},                   // following error actual value
    {0x60FD, 0, u32, ro, ram},                   // digital inputs
    {0x60FF, 0, i32, rw, ram},                   // target velocity
    {0x6502, 0, u32, ro, ram, 0x3ED},            // supported drive modes
};

constexpr ObjectEntry simpliq_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},        // save all parameters
    {0x6007, 0, i16, rw, eeprom},        // abort connection option code
    {0x603F, 0, u16, ro, ram},           // error code
    {0x6040, 0, u16, rw, ram},           // controlword
    {0x6041, 0, u16, ro, ram},           // statusword
    {0x605A, 0, i16, rw, eeprom, 2},     // quick stop option code
    {0x605B, 0, i16, rw, eeprom},        // shutdown option code
    {0x605C, 0, i16, rw, eeprom, 1},     // disable operation option code
    {0x605D, 0, i16, rw, eeprom, 1},     // halt option code
    {0x605E, 0, i16, rw, eeprom, 2},     // fault reaction option code
    {0x6060, 0, i8, rw, ram},            // modes of operation
    {0x6061, 0, i8, ro, ram},            // modes of operation display
    {0x6062, 0, i32, ro, ram},           // position demand value
    {0x6063, 0, i32, ro, ram},           // position actual internal value
    {0x6064, 0, i32, ro, ram},           // position actual value
    {0x6065, 0, u32, rw, eeprom},        // following error window
    {0x6067, 0, u32, rw, eeprom},        // position window
    {0x606B, 0, i32, ro, ram},           // velocity demand value
    {0x606C, 0, i32, ro, ram},           // velocity actual value
    {0x6071, 0, i16, rw, ram},           // target torque
    {0x6072, 0, u16, rw, eeprom},        // max torque
    {0x6074, 0, i16, ro, ram},           // torque demand
    {0x6077, 0, i16, ro, ram},           // torque actual value
    {0x6078, 0, i16, ro, ram},           // current actual value
    {0x607A, 0, i32, rw, ram},           // target position
    {0x607C, 0, i32, rw, eeprom},        // home offset
    {0x607D, 1, i32, rw, eeprom},        // software position limit min position limit
    {0x607D, 2, i32, rw, eeprom},        // software position limit max position limit
    {0x607F, 0, u32, rw, eeprom},        // max profile velocity
    {0x6080, 0, u32, rw, eeprom},        // max motor speed
    {0x6081, 0, u32, rw, eeprom, 4066},  // profile velocity
    {0x6083, 0, u32, rw, eeprom},        // profile acceleration
    {0x6084, 0, u32, rw, eeprom},        // profile deceleration
    {0x6085, 0, u32, rw, eeprom},        // quick stop deceleration
    {0x608F, 1, u32, rw, eeprom, 1},     // position encoder resolution encoder increments
    {0x608F, 2, u32, rw, eeprom, 1},     // position encoder resolution motor revolutions
    {0x6098, 0, i8, rw, eeprom},         // homing method
    {0x6099, 1, u32, rw, eeprom},        // homing speeds speed during search for switch
    {0x6099, 2, u32, rw, eeprom},        // homing speeds speed during search for zero
    {0x609A, 0, u32, rw, eeprom},        // homing acceleration
    {0x60FD, 0, u32, ro, ram},           // digital inputs
    {0x60FF, 0, i32, rw, ram},           // target velocity
    {0x6502, 0, u32, ro, ram, 0x6D},     // supported drive modes
};

// Of both: what their files do not let map.
constexpr ObjectKey elmo_unmappable[] = {{0x6007, 0}, {0x603F, 0}, {0x605A, 0}, {0x605B, 0}, {0x605C, 0}, {0x605D, 0},
                                         {0x605E, 0}, {0x6065, 0}, {0x6067, 0}, {0x6072, 0}, {0x6079, 0}, {0x607C, 0},
                                         {0x607D, 1}, {0x607D, 2}, {0x607F, 0}, {0x6080, 0}, {0x608F, 1}, {0x608F, 2},
                                         {0x6098, 0}, {0x6099, 1}, {0x6099, 2}, {0x609A, 0}, {0x6502, 0}};

EdsUnits elmo_units(const ObjectDictionary&, std::int64_t counts) { return counts_of_encoder(counts); }

}  // namespace

constinit const EdsDriveType elmo_gold_type{
    .name = "elmo-gold",
    .device_name = "Gold Drive",
    .identity = {0x0000009A, 0x00030923, 0x000103F6, 1},
    .device_type = 0x00000192,
    .objects = gold_objects,
    .unmappable = elmo_unmappable,
    .encoder_counts = 4096,
    .units = elmo_units,
    .tells_counts = false,
    .consumers = 2,
};

constinit const EdsDriveType elmo_simpliq_type{
    .name = "elmo-simpliq",
    .device_name = "SimplIQ",
    .identity = {0x0000009A, 0, 0, 1},
    .device_type = 0x00020192,
    .objects = simpliq_objects,
    .unmappable = elmo_unmappable,
    .encoder_counts = 4096,
    .units = elmo_units,
    .tells_counts = false,
};

}  // namespace axisgate::simulated
