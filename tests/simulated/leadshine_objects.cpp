// SPDX-License-Identifier: Apache-2.0
// Special, vendor and CiA 402 objects of the LD2-CAN, 3000h to 6000h (3.3 to 3.5). What is not printed is as CiA 402
// has it.
#include "tests/simulated/leadshine_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry leadshine_object_entries[] = {
    {0x3000, 0x00, u16, ro, ram},                               // I/O signal status
    {0x3001, 0x00, u16, ro, ram},                               // state transition flag
    {0x3002, 0x00, u16, rw, ram},                               // EEPROM save trigger
    {0x3003, 0x00, u16, ro, ram},                               // EEPROM save status
    {0x3004, 0x00, u16, rw, ram},                               // I/O output setting
    {0x3010, 0x00, u16, ro, ram},                               // servo alarm code
    {0x4000, 0x00, u16, rw, ram},                               // clear alarm
    {0x5004, 0x01, u16, rw, eeprom, 8},                         // RPDO length in use
    {0x5004, 0x02, u16, rw, eeprom, 17},                        // TPDO length in use
    {0x5004, 0x03, u16, rw, eeprom, 1},                         // number of RPDOs
    {0x5004, 0x04, u16, rw, eeprom, 1},                         // number of TPDOs
    {0x5004, 0x05, u16, rw, eeprom},                            // timeout watchdog counter
    {0x5004, 0x06, u16, rw, eeprom},                            // disconnection watchdog time
    {0x5004, 0x07, u16, rw, eeprom, 4},                         // sync0 period calculation
    {0x5004, 0x08, u16, rw, eeprom},                            // sync0 drift watchdog counter
    {0x5004, 0x09, u16, rw, eeprom, 4},                         // sync0 drift watchdog limit
    {0x5004, 0x0A, u16, rw, eeprom},                            // SM2 watchdog counter
    {0x5004, 0x0B, u16, rw, eeprom, 4},                         // SM2 watchdog limit
    {0x5004, 0x0C, u16, rw, eeprom},                            // application SM2/Sync0 watchdog counter
    {0x5004, 0x0D, u16, rw, eeprom, 4},                         // application SM2/Sync0 watchdog limit
    {0x5004, 0x0E, u16, rw, eeprom},                            // manufacturer reserved
    {0x5004, 0x0F, u32, rw, eeprom},                            // SM2 to Sync0 interval
    {0x5006, 0x00, u16, rw, eeprom, 65535},                     // sync alarm enable mask
    {0x5010, 0x00, u16, rw, eeprom, 0, 0, 60000},               // PDO watchdog timeout
    {0x5012, 0x04, u16, rw, eeprom, 5},                         // homing options
    {0x5400, 0x01, u32, rw, eeprom, 250, 125, 1000},            // sync period minimum
    {0x5400, 0x02, u32, rw, eeprom, 10000, 4000, 20000},        // sync period maximum
    {0x5500, 0x01, i32, ro, ram},                               // absolute encoder turns
    {0x5500, 0x02, i32, ro, ram},                               // single-turn position
    {0x5500, 0x03, i32, ro, ram},                               // encoder feedback position low 32 bits
    {0x5500, 0x04, i32, ro, ram},                               // encoder feedback position high 32 bits
    {0x5500, 0x05, i32, ro, ram},                               // mechanical position low 32 bits
    {0x5500, 0x06, i32, ro, ram},                               // mechanical position high 32 bits
    {0x5500, 0x07, i32, ro, ram},                               // encoder communication error count
    {0x5501, 0x01, i16, ro, ram},                               // motor speed
    {0x5501, 0x02, i16, ro, ram},                               // position command speed
    {0x5501, 0x03, i16, ro, ram},                               // speed command
    {0x5501, 0x04, i16, ro, ram},                               // actual torque
    {0x5501, 0x05, i16, ro, ram},                               // torque command
    {0x5501, 0x06, i32, ro, ram},                               // relative position error
    {0x5501, 0x07, i32, ro, ram},                               // internal position command
    {0x5501, 0x08, i16, ro, ram},                               // overload ratio
    {0x5501, 0x09, i16, ro, ram},                               // regeneration load ratio
    {0x5501, 0x0A, i16, ro, ram},                               // inertia ratio
    {0x5501, 0x0B, i16, ro, ram},                               // actual positive torque limit
    {0x5501, 0x0C, i16, ro, ram},                               // actual negative torque limit
    {0x5501, 0x0D, i16, ro, ram},                               // u phase current
    {0x5501, 0x0E, i16, ro, ram},                               // w phase current
    {0x5502, 0x01, i16, ro, ram},                               // SI physical signals
    {0x5502, 0x02, i16, ro, ram},                               // SO physical signals
    {0x5502, 0x03, i16, ro, ram},                               // reserved
    {0x5502, 0x04, i16, ro, ram},                               // reserved
    {0x5502, 0x05, i16, ro, ram, 48},                           // bus voltage
    {0x5502, 0x06, i16, ro, ram, 30},                           // temperature
    {0x5502, 0x07, u32, ro, ram},                               // power-on time
    {0x603F, 0x00, u16, ro, ram},                               // error code
    {0x6040, 0x00, u16, rw, ram},                               // controlword
    {0x6041, 0x00, u16, ro, ram},                               // statusword
    {0x605A, 0x00, i16, rw, eeprom, 6, 0, 7},                   // quick stop option code
    {0x605B, 0x00, i16, rw, eeprom, 0, 0, 1},                   // shutdown option code
    {0x605C, 0x00, i16, rw, eeprom, 0, 0, 1},                   // disable operation option code
    {0x605D, 0x00, i16, rw, eeprom, 1, 1, 4},                   // halt option code
    {0x605E, 0x00, i16, rw, eeprom, 0, 0, 3},                   // fault reaction option code
    {0x6060, 0x00, i8, rw, ram, 8, 0, 11},                      // modes of operation
    {0x6061, 0x00, i8, ro, ram},                                // modes of operation display
    {0x6062, 0x00, i32, ro, ram},                               // position demand (before direction)
    {0x6063, 0x00, i32, ro, ram},                               // position actual internal value
    {0x6064, 0x00, i32, ro, ram},                               // position actual value
    {0x6065, 0x00, u32, rw, eeprom, 10000, 0, 2147483647},      // following error window
    {0x6066, 0x00, u16, rw, eeprom, 10},                        // following error time-out
    {0x606B, 0x00, i32, ro, ram},                               // velocity demand (internal)
    {0x606C, 0x00, i32, ro, ram},                               // velocity actual value
    {0x6071, 0x00, i16, rw, ram},                               // target torque
    {0x6072, 0x00, u16, rw, eeprom, 3000},                      // max torque
    {0x6073, 0x00, u16, rw, eeprom, 3000},                      // max current
    {0x6074, 0x00, i16, ro, ram},                               // torque demand
    {0x6075, 0x00, u32, ro, ram, 20000},                        // motor rated current
    {0x6076, 0x00, u32, ro, ram, 2400},                         // motor rated torque
    {0x6077, 0x00, i16, ro, ram},                               // torque actual value
    {0x6079, 0x00, u32, ro, ram, 48000},                        // DC link voltage
    {0x607A, 0x00, i32, rw, ram},                               // target position
    {0x607C, 0x00, i32, rw, eeprom},                            // home offset
    {0x607D, 0x01, i32, rw, eeprom},                            // software position limit: minimum
    {0x607D, 0x02, i32, rw, eeprom},                            // software position limit: maximum
    {0x607E, 0x00, u8, rw, eeprom},                             // polarity
    {0x607F, 0x00, u32, rw, eeprom, 2147483647},                // max profile velocity
    {0x6080, 0x00, u32, rw, eeprom, 5000, 0, 6000},             // max motor speed
    {0x6081, 0x00, u32, rw, eeprom, 10000, 0, 2147483647},      // profile velocity
    {0x6083, 0x00, u32, rw, eeprom, 10000, 1, 2147483647},      // profile acceleration
    {0x6084, 0x00, u32, rw, eeprom, 10000, 1, 2147483647},      // profile deceleration
    {0x6085, 0x00, u32, rw, eeprom, 10000000, 1, 2147483647},   // quick stop deceleration
    {0x6087, 0x00, u32, rw, eeprom, 100, 1, 2147483647},        // torque slope
    {0x608F, 0x01, i32, ro, ram},                               // encoder resolution: encoder increments
    {0x608F, 0x02, u32, ro, ram, 1},                            // encoder resolution: motor revolutions
    {0x6091, 0x01, i32, rw, eeprom, 1, 1, 2147483647},          // gear ratio: numerator
    {0x6091, 0x02, i32, rw, eeprom, 1, 1, 2147483647},          // gear ratio: denominator
    {0x6092, 0x01, i32, rw, eeprom, 10000, 1, 2147483647},      // feed constant: pulses per revolution
    {0x6092, 0x02, u32, rw, eeprom, 1},                         // feed constant: shaft revolutions
    {0x6098, 0x00, i8, rw, ram, 19, -6, 37},                    // homing method
    {0x6099, 0x01, u32, rw, eeprom, 10000, 0, 2147483647},      // homing speed: search (high)
    {0x6099, 0x02, u32, rw, eeprom, 5000, 0, 2147483647},       // homing speed: zero (low)
    {0x609A, 0x00, u32, rw, eeprom, 10000, 0, 2147483647},      // homing acceleration
    {0x60B0, 0x00, i32, rw, ram},                               // position offset / feed-forward
    {0x60B1, 0x00, i32, rw, ram},                               // velocity offset / feed-forward
    {0x60B2, 0x00, i16, rw, ram},                               // torque offset / feed-forward
    {0x60B8, 0x00, u16, rw, ram},                               // touch probe function
    {0x60B9, 0x00, u16, ro, ram},                               // touch probe status
    {0x60BA, 0x00, i32, ro, ram},                               // probe 1 rising edge position
    {0x60BB, 0x00, i32, ro, ram},                               // probe 1 falling edge position
    {0x60BC, 0x00, i32, ro, ram},                               // probe 2 rising edge position
    {0x60BD, 0x00, i32, ro, ram},                               // probe 2 falling edge position
    {0x60C2, 0x01, u8, rw, eeprom, 2},                          // interpolation period value
    {0x60C2, 0x02, i8, rw, eeprom, -3},                         // interpolation time index
    {0x60C5, 0x00, u32, rw, eeprom, 100000000, 1, 2147483647},  // max profile acceleration
    {0x60C6, 0x00, u32, rw, eeprom, 100000000, 1, 2147483647},  // max profile deceleration
    {0x60D5, 0x00, u16, ro, ram},                               // probe 1 rising edge count
    {0x60D6, 0x00, u16, ro, ram},                               // probe 1 falling edge count
    {0x60D7, 0x00, u16, ro, ram},                               // probe 2 rising edge count
    {0x60D8, 0x00, u16, ro, ram},                               // probe 2 falling edge count
    {0x60E0, 0x00, u16, rw, eeprom, 3000},                      // positive torque limit
    {0x60E1, 0x00, u16, rw, eeprom, 3000},                      // negative torque limit
    {0x60F4, 0x00, i32, ro, ram},                               // following error actual value
    {0x60FA, 0x00, i32, ro, ram},                               // position loop output velocity
    {0x60FC, 0x00, i32, ro, ram},                               // position demand internal
    {0x60FD, 0x00, u32, ro, ram},                               // digital inputs
    {0x60FE, 0x01, u32, rw, ram},                               // digital outputs: level
    {0x60FE, 0x02, u32, rw, ram},                               // digital outputs: enable mask
    {0x60FF, 0x00, i32, rw, ram},                               // target velocity
    {0x6502, 0x00, u32, ro, ram, 45},                           // supported drive modes
};

}  // namespace

std::span<const ObjectEntry> leadshine_objects() { return leadshine_object_entries; }

}  // namespace axisgate::simulated
