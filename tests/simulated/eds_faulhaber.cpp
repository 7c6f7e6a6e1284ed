// SPDX-License-Identifier: Apache-2.0
// Faulhaber MCBL 300x CO: objects, widths, defaults and limits as a public EDS of firmware 3150.67B has them.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry faulhaber_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},                   // save all parameters
    {0x2320, 0, u16, ro, ram},                      // faulhaber fault register
    {0x2323, 1, u16, ro, ram},                      // housing temperature
    {0x2351, 3, u32, ro, ram, 3000},                // resolution internal encoder
    {0x6040, 0, u16, rw, ram},                      // controlword
    {0x6041, 0, u16, ro, ram},                      // statusword
    {0x6060, 0, i8, rw, ram, 1, -9, 6},             // modes of operation
    {0x6061, 0, i8, ro, ram, 1},                    // modes of operation display
    {0x6062, 0, i32, ro, ram},                      // position demand value
    {0x6063, 0, i32, ro, ram},                      // position actual internal value
    {0x6064, 0, i32, ro, ram},                      // position actual value
    {0x6067, 0, u32, rw, eeprom, 20, 1, 32000},     // position window
    {0x606B, 0, i32, ro, ram},                      // velocity demand value
    {0x606C, 0, i32, ro, ram},                      // velocity actual value
    {0x6078, 0, i16, ro, ram},                      // current actual value
    {0x607A, 0, i32, rw, ram},                      // target position
    {0x607C, 0, i32, rw, eeprom},                   // home offset
    {0x607D, 1, i32, rw, eeprom, -1800000000},      // minimum position limit
    {0x607D, 2, i32, rw, eeprom, 1800000000},       // maximum position limit
    {0x607F, 0, u32, rw, eeprom, 0, 0, 30000},      // max profile velocity
    {0x6081, 0, u32, rw, eeprom, 0, 0, 30000},      // profile velocity
    {0x6083, 0, u32, rw, eeprom, 30000, 0, 32000},  // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 30000, 0, 32000},  // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 30000, 0, 32000},  // quick stop deceleration
    {0x608F, 1, u32, ro, ram, 3000},                // encoder increments
    {0x608F, 2, u32, ro, ram, 1},                   // motor revolutions
    {0x6091, 1, u32, rw, eeprom, 1, 1, 32700},      // motor revolutions
    {0x6091, 2, u32, rw, eeprom, 1, 1, 32700},      // shaft revolutions
    {0x6092, 1, u32, rw, eeprom, 3000, 1, 32700},   // feed
    {0x6092, 2, u32, rw, eeprom, 1, 1, 32700},      // shaft revolutions
    {0x6098, 0, i8, rw, eeprom, 20, 0, 36},         // homing method
    {0x6099, 1, u32, rw, eeprom, 400, 0, 30000},    // switch seek velocity
    {0x6099, 2, u32, rw, eeprom, 100, 0, 30000},    // homing velocity
    {0x609A, 0, u32, rw, eeprom, 50, 0, 32000},     // homing acceleration
    {0x60FD, 0, u32, ro, ram},                      // digital inputs
    {0x60FF, 0, i32, rw, ram},                      // target velocity
    {0x6502, 0, u32, ro, ram, 0x25},                // supported drive modes
};

constexpr ObjectKey faulhaber_unmappable[] = {{0x608F, 1}, {0x608F, 2}, {0x6091, 1},
                                              {0x6091, 2}, {0x6092, 1}, {0x6092, 2}};

// 6092h says what a turn behind the gear is; speeds are those of the motor in rpm, ramps in turns a second squared.
EdsUnits faulhaber_units(const ObjectDictionary& of, std::int64_t) {
  const std::int64_t num = of.get({0x6092, 1}) * of.get({0x6091, 2}), den = of.get({0x6092, 2}) * of.get({0x6091, 1});
  return {{num, den}, {60}, {1}};
}

}  // namespace

constinit const EdsDriveType faulhaber_type{
    .name = "faulhaber-mcbl",
    .device_name = "MCBL3006",
    .identity = {0x00000147, 3150, 2, 1},
    .device_type = 0x00420192,
    .objects = faulhaber_objects,
    .unmappable = faulhaber_unmappable,
    .encoder_counts = 3000,
    .units = faulhaber_units,
    .guarding = true,
    .inhibit_time = false,
    .event_timer = false,
    .mapped_most = 4,
    .quick_stop = 6,  // no file says it: the harder one for a master
};

}  // namespace axisgate::simulated
