// SPDX-License-Identifier: Apache-2.0
// ZeroErr eRob: objects, widths, defaults and limits as a public EDS (V1.5) has them; where it has none, plausible
// ones.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry zeroerr_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},                   // save all parameters
    {0x22A2, 0, u16, ro, ram, 40},                  // drive temperature
    {0x603F, 0, u16, ro, ram},                      // error code
    {0x6040, 0, u16, rw, ram},                      // controlword
    {0x6041, 0, u16, ro, ram},                      // statusword
    {0x605B, 0, i16, rw, eeprom},                   // shutdown option code
    {0x605E, 0, i16, rw, eeprom, 2},                // fault reaction option code
    {0x6060, 0, i8, rw, ram},                       // modes of operation
    {0x6061, 0, i8, ro, ram},                       // modes of operation display
    {0x6062, 0, i32, ro, ram},                      // position demand value
    {0x6064, 0, i32, ro, ram},                      // position actual value
    {0x6065, 0, i32, rw, eeprom, 100000},           // following error window
    {0x6067, 0, i32, rw, eeprom, 100},              // position window
    {0x606B, 0, i32, rw, eeprom},                   // velocity demand value
    {0x606C, 0, i32, ro, ram},                      // velocity actual value
    {0x6071, 0, i16, rw, ram},                      // target torque
    {0x6074, 0, i16, ro, ram},                      // torque demand value
    {0x6077, 0, i16, ro, ram},                      // torque actual value
    {0x6078, 0, i16, ro, ram},                      // current actual value
    {0x6079, 0, u32, ro, ram, 48000},               // dc link circuit voltage
    {0x607A, 0, i32, rw, ram},                      // target position
    {0x607C, 0, i32, rw, eeprom},                   // home offset
    {0x607D, 1, i32, rw, eeprom, -2147483648},      // min position limit
    {0x607D, 2, i32, rw, eeprom, 2147483647},       // max position limit
    {0x607F, 0, u32, rw, eeprom, 9000000},          // max profile velocity
    {0x6080, 0, u32, rw, eeprom, 1000},             // max motor speed
    {0x6081, 0, u32, rw, eeprom, 524288},           // profile velocity
    {0x6083, 0, u32, rw, eeprom, 524288},           // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 524288},           // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 65500, 1, 65500},  // quick stop deceleration
    {0x6093, 1, u32, rw, eeprom, 1},                // numerator
    {0x6093, 2, u32, rw, eeprom, 1},                // feed constant
    {0x6098, 0, i8, rw, eeprom, 0, 0, 35},          // homing method
    {0x6099, 1, u32, rw, eeprom, 20000, 1, 20000},  // speed during search for switch
    {0x6099, 2, u32, rw, eeprom, 5000, 1, 5000},    // speed during search for zero
    {0x609A, 0, u32, rw, eeprom, 100000},           // homing acceleration
    {0x60F4, 0, i32, ro, ram},                      // following error actual value
    {0x60FD, 0, u32, ro, ram},                      // digital inputs
    {0x60FF, 0, i32, rw, ram},                      // target velocity
    {0x6502, 0, u32, ro, ram, 0x38d},               // supported drive modes
};

constexpr ObjectKey zeroerr_unmappable[] = {{0x605B, 0}, {0x605E, 0}};

// Counts of the encoder behind the gear, per second and per second squared.
EdsUnits zeroerr_units(const ObjectDictionary&, std::int64_t counts) { return counts_of_encoder(counts); }

}  // namespace

constinit const EdsDriveType zeroerr_type{
    .name = "zeroerr-erob",
    .device_name = "eDriver",
    .identity = {0x5A65726F, 0x26483052, 0x00020111, 1},
    .device_type = 0x00420192,
    .objects = zeroerr_objects,
    .unmappable = zeroerr_unmappable,
    .encoder_counts = 524288,
    .units = zeroerr_units,
    .tells_counts = false,
    .guarding = true,
    .quick_stop = 1,   // there is no 605Ah, and what 6085h counts in (1 to 65500) is not known
    .master_lost = 2,  // nor is this in any file
};

}  // namespace axisgate::simulated
