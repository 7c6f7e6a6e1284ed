// SPDX-License-Identifier: Apache-2.0
// Technosoft iPOS: objects, widths and defaults as a public EDS (iPOS.D.v1.04) has them.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry technosoft_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},         // save all parameters
    {0x6007, 0, i16, rw, eeprom},         // abort connection option code
    {0x6040, 0, u16, rw, ram},            // control word
    {0x6041, 0, u16, ro, ram},            // status word
    {0x605A, 0, i16, rw, eeprom, 2},      // quick stop option code
    {0x605B, 0, i16, rw, eeprom},         // shutdown option code
    {0x605C, 0, i16, rw, eeprom, 1},      // disable operation option code
    {0x605D, 0, i16, rw, eeprom, 1},      // halt option code
    {0x605E, 0, i16, rw, eeprom, 2},      // fault reaction option code
    {0x6060, 0, i8, rw, ram},             // modes of operation
    {0x6061, 0, i8, ro, ram},             // modes of operation display
    {0x6062, 0, i32, ro, ram},            // position demand value
    {0x6063, 0, i32, ro, ram},            // position actual internal value
    {0x6064, 0, i32, ro, ram},            // position actual value
    {0x6065, 0, u32, rw, eeprom},         // following error window
    {0x6067, 0, u32, rw, eeprom},         // position window
    {0x606B, 0, i32, ro, ram},            // velocity demand value
    {0x606C, 0, i32, ro, ram},            // velocity actual value
    {0x6071, 0, i16, rw, ram},            // target torque
    {0x6077, 0, i16, ro, ram},            // torque actual value
    {0x607A, 0, i32, rw, ram},            // target position
    {0x607C, 0, i32, rw, eeprom},         // home offset
    {0x607D, 1, i32, rw, eeprom},         // minimal position limit
    {0x607D, 2, i32, rw, eeprom},         // maximal position limit
    {0x6081, 0, u32, rw, eeprom},         // profile velocity
    {0x6083, 0, u32, rw, eeprom},         // profile acceleration
    {0x6085, 0, u32, rw, eeprom},         // quick stop deceleration
    {0x6098, 0, i8, rw, eeprom},          // homing method
    {0x6099, 1, u32, rw, eeprom},         // speed during search for switch
    {0x6099, 2, u32, rw, eeprom},         // speed during search for zero
    {0x609A, 0, u32, rw, eeprom},         // homing acceleration
    {0x60F4, 0, i32, ro, ram},            // following error actual value
    {0x60FD, 0, u32, ro, ram},            // digital inputs
    {0x60FF, 0, i32, rw, ram},            // target velocity
    {0x6502, 0, u32, ro, ram, 0x1F0065},  // supported drive modes
};

constexpr ObjectKey technosoft_unmappable[] = {{0x6007, 0}, {0x605A, 0}, {0x605B, 0},
                                               {0x605C, 0}, {0x605D, 0}, {0x605E, 0}};

// Counts in a sample of its slow loop, 1 ms, and 65536 parts of that.
EdsUnits technosoft_units(const ObjectDictionary&, std::int64_t counts) {
  constexpr std::int64_t parts = 65536, samples_per_second = 1000;
  return {{counts}, {parts * counts, samples_per_second}, {parts * counts, samples_per_second * samples_per_second}};
}

}  // namespace

constinit const EdsDriveType technosoft_type{
    .name = "technosoft-ipos",
    .device_name = "iPOS",
    .identity = {0x000001A3, 0, 0, 1},
    .device_type = 0x00060192,
    .objects = technosoft_objects,
    .unmappable = technosoft_unmappable,
    .encoder_counts = 2000,
    .units = technosoft_units,
    .tells_counts = false,
    .consumers = 0,
    .guarding = true,
};

}  // namespace axisgate::simulated
