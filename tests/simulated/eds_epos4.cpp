// SPDX-License-Identifier: Apache-2.0
// maxon EPOS4 50/15: objects, widths, defaults and limits as a public DCF of firmware 0170h has them.
#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr std::int64_t widest_epos4 = 4294967295;

constexpr ObjectEntry epos4_objects[] = {
    {0x1010, 1, u32, rw, ram, 1},                          // store parameters
    {0x2200, 1, u16, ro, ram, 240},                        // supply voltage, 0.1 V
    {0x3000, 5, u32, ro, ram, 3200},                       // main sensor resolution
    {0x30B0, 0, i32, rw, eeprom},                          // home position
    {0x3201, 1, i16, ro, ram, 300},                        // temperature of the power stage, 0.1 degC
    {0x6007, 0, i16, rw, eeprom, 3, 0, 3},                 // abort connection option code
    {0x603F, 0, u16, ro, ram},                             // error code
    {0x6040, 0, u16, rw, ram},                             // controlword
    {0x6041, 0, u16, ro, ram},                             // statusword
    {0x605A, 0, i16, rw, eeprom, 6},                       // quick stop option code
    {0x605B, 0, i16, rw, eeprom, 0},                       // shutdown option code
    {0x605C, 0, i16, rw, eeprom, 1},                       // disable operation option code
    {0x605E, 0, i16, rw, eeprom, 2},                       // fault reaction option code
    {0x6060, 0, i8, rw, eeprom, 1},                        // modes of operation
    {0x6061, 0, i8, ro, ram},                              // modes of operation display
    {0x6062, 0, i32, ro, ram},                             // position demand
    {0x6064, 0, i32, ro, ram},                             // position actual
    {0x6065, 0, u32, rw, eeprom, 2000},                    // following error window
    {0x6067, 0, u32, rw, eeprom, widest_epos4},            // position window
    {0x606B, 0, i32, ro, ram},                             // velocity demand
    {0x606C, 0, i32, ro, ram},                             // velocity actual
    {0x6071, 0, i16, rw, ram, 0, -2000, 2000},             // target torque
    {0x6076, 0, u32, rw, eeprom, 512871},                  // motor rated torque
    {0x6077, 0, i16, ro, ram},                             // torque actual
    {0x607A, 0, i32, rw, ram},                             // target position
    {0x607D, 1, i32, rw, eeprom},                          // position limit, minimum
    {0x607D, 2, i32, rw, eeprom},                          // position limit, maximum
    {0x607F, 0, u32, rw, eeprom, 50000, 1, 50000},         // max profile velocity
    {0x6080, 0, u32, rw, eeprom, 50000, 1, 50000},         // max motor speed
    {0x6081, 0, u32, rw, eeprom, 1000, 1, 50000},          // profile velocity
    {0x6083, 0, u32, rw, eeprom, 10000, 1, widest_epos4},  // profile acceleration
    {0x6084, 0, u32, rw, eeprom, 10000, 1, widest_epos4},  // profile deceleration
    {0x6085, 0, u32, rw, eeprom, 10000, 1, widest_epos4},  // quick stop deceleration
    {0x6098, 0, i8, rw, eeprom},                           // homing method
    {0x6099, 1, u32, rw, eeprom, 100, 1, 50000},           // speed for switch search
    {0x6099, 2, u32, rw, eeprom, 10, 1, 50000},            // speed for zero search
    {0x609A, 0, u32, rw, eeprom, 1000, 1, widest_epos4},   // homing acceleration
    {0x60A8, 0, u32, rw, eeprom, 0x00B50000},              // SI unit position: increments
    {0x60A9, 0, u32, rw, eeprom, 0x00B44700},              // SI unit velocity: rpm
    {0x60AA, 0, u32, rw, eeprom, 0x00C00300},              // SI unit acceleration: rpm/s
    {0x60F4, 0, i32, ro, ram},                             // following error
    {0x60FD, 0, u32, ro, ram},                             // digital inputs
    {0x60FF, 0, i32, rw, ram, 0, -100000, 100000},         // target velocity
    {0x6502, 0, u32, ro, ram, 0x3A5},                      // supported drive modes
};

constexpr std::int8_t epos4_homing[] = {37, 34, 33, 27, 23, 18, 17, 11, 7, 2, 1, -1, -2, -3, -4};  // 60E3h

// The exponent of 60A9h (bits 24 to 31) makes the speed finer: tenths, hundredths, thousandths of a rpm.
EdsUnits epos4_units(const ObjectDictionary& of, std::int64_t counts) {
  EdsUnits is = counts_and_rpm(counts);
  const auto exponent = static_cast<std::int8_t>(of.get({0x60A9, 0}) >> 24);
  for (int power = 0; power > exponent; --power) is.speed.of *= 10;
  return is;
}

}  // namespace

constinit const EdsDriveType epos4_type{
    .name = "maxon-epos4",
    .device_name = "EPOS4",
    .identity = {0x000000FB, 0x65520000, 0x01700000, 1},
    .device_type = 0x00020192,
    .objects = epos4_objects,
    .homing = epos4_homing,
    .encoder_counts = 3200,
    .units = epos4_units,
    .consumers = 2,
    .event_timer = false,
    .mapped_most = 12,
    .torque_mode = 10,
};

}  // namespace axisgate::simulated
