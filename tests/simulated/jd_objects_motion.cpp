// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/jd_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

// Defaults the sheet leaves open (6081, 6073, 6099, 609A, 6079, 60F7:0B): a plausible figure, never relied upon.
// Signs marked `?` in the sheet are taken as the sheet shows them.
constexpr ObjectEntry jd_motion_entries[] = {
    // JD 4.1 control and mode
    {0x6040, 0x00, u16, rw, ram},             // control word
    {0x6041, 0x00, u16, ro, ram},             // status word
    {0x6060, 0x00, i8, rw, ram, -4},          // operation mode
    {0x6061, 0x00, i8, ro, ram},              // effective operation mode
    {0x2FF0, 0x05, u8, rw, ram},              // simplified control word
    {0x2000, 0x00, u8, rw, eeprom, 0, 0, 1},  // auto-enable at power-up
    {0x607E, 0x00, u8, rw, eeprom, 0, 0, 1},  // direction polarity of speed and position
    // JD 4.2 measured values
    {0x6063, 0x00, i32, ro, ram},       // actual position
    {0x606C, 0x00, i16, ro, ram},       // actual speed
    {0x6078, 0x00, i16, ro, ram},       // actual current
    {0x60FD, 0x00, u32, ro, ram},       // input state (CiA 402 style)
    {0x6079, 0x00, u16, ro, ram, 310},  // actual DC bus voltage
    {0x60F7, 0x0B, i16, ro, ram, 35},   // drive temperature
    {0x60F7, 0x0C, u16, ro, ram},       // DC bus ripple
    {0x60F7, 0x0D, u16, ro, ram},       // brake resistor actual power
    {0x60FB, 0x08, i32, ro, ram},       // position following error
    {0x60F6, 0x0C, i16, ro, ram},       // effective target current q
    {0x60F6, 0x17, i16, ro, ram},       // actual current q
    {0x60F6, 0x18, i16, ro, ram},       // actual current d
    {0x60F6, 0x14, i16, ro, ram},       // U-phase current
    {0x60F6, 0x15, i16, ro, ram},       // V-phase current
    {0x60F6, 0x16, i16, ro, ram},       // current phase angle
    {0x60F6, 0x1D, i16, ro, ram},       // PID-q output 16
    {0x60F6, 0x1E, i16, ro, ram},       // PID-d output 16
    {0x60F6, 0x1F, i16, ro, ram},       // U-phase voltage
    {0x60F6, 0x20, i16, ro, ram},       // V-phase voltage
    {0x60F6, 0x12, u16, ro, ram},       // motor actual Iit
    {0x60F6, 0x10, u16, ro, ram},       // drive actual Iit
    {0x2FF0, 0x10, u8, ro, ram},        // motor Iit utilisation
    {0x2FF0, 0x11, u8, ro, ram},        // drive Iit utilisation
    {0x2FF0, 0x12, u8, ro, ram},        // brake resistor utilisation
    {0x2FF0, 0x0F, u32, ro, ram, 1},    // software version (short)
    {0x2FF7, 0x00, u32, ro, ram},       // accumulated working time
    {0x60F9, 0x19, i16, ro, ram},       // actual speed, low-speed scale
    {0x60F9, 0x1A, i16, ro, ram},       // actual speed per ms
    {0x3010, 0x04, i32, ro, ram},       // index capture position
    {0x2501, 0x04, i16, ro, ram},       // ADC 1, V current raw
    {0x2501, 0x05, i16, ro, ram},       // ADC 2, U current raw
    {0x3010, 0x06, u16, ro, ram},       // internal flags 1
    {0x3010, 0x07, u16, ro, ram},       // internal flags 2
    {0x3010, 0x08, u16, ro, ram},       // internal flags 3
    {0x2502, 0x0F, i16, ro, ram},       // analog input 1 effective data
    {0x2502, 0x10, i16, ro, ram},       // analog input 2 effective data
    // JD 4.3 targets and profile
    {0x607A, 0x00, i32, rw, ram},                          // target position
    {0x6081, 0x00, u32, rw, ram, 273067},                  // profile velocity
    {0x6083, 0x00, u32, rw, eeprom, 100000},               // profile acceleration
    {0x6084, 0x00, u32, rw, eeprom, 100000},               // profile deceleration
    {0x60FF, 0x00, i32, rw, ram, 0, -16777215, 16777215},  // target speed
    {0x6071, 0x00, i16, rw, ram, 0, -2047, 2047},          // target current
    {0x60F6, 0x08, i16, rw, ram},                          // target current, address of section 8.4
    {0x6073, 0x00, u16, rw, eeprom, 2047},                 // target current limit
    {0x6080, 0x00, u16, rw, eeprom, 5000, 0, 6000},        // maximum speed limit
    {0x2FF0, 0x09, i16, rw, ram},                          // target speed in rpm
    {0x2FF0, 0x06, u16, rw, eeprom, 610, 0, 2000},         // simplified acceleration
    {0x2FF0, 0x07, u16, rw, eeprom, 610, 0, 2000},         // simplified deceleration
    // JD 4.4 internal segments
    {0x2020, 0x01, i32, rw, eeprom},          // multi-position 0
    {0x2020, 0x02, i32, rw, eeprom},          // multi-position 1
    {0x2020, 0x03, i32, rw, eeprom},          // multi-position 2
    {0x2020, 0x04, i32, rw, eeprom},          // multi-position 3
    {0x2020, 0x10, i32, rw, eeprom},          // multi-position 4
    {0x2020, 0x11, i32, rw, eeprom},          // multi-position 5
    {0x2020, 0x12, i32, rw, eeprom},          // multi-position 6
    {0x2020, 0x13, i32, rw, eeprom},          // multi-position 7
    {0x2020, 0x05, i32, rw, eeprom},          // multi-speed 0 (32 bit)
    {0x2020, 0x06, i32, rw, eeprom},          // multi-speed 1 (32 bit)
    {0x2020, 0x07, i32, rw, eeprom},          // multi-speed 2 (32 bit)
    {0x2020, 0x08, i32, rw, eeprom},          // multi-speed 3 (32 bit)
    {0x2020, 0x14, i32, rw, eeprom},          // multi-speed 4 (32 bit)
    {0x2020, 0x15, i32, rw, eeprom},          // multi-speed 5 (32 bit)
    {0x2020, 0x16, i32, rw, eeprom},          // multi-speed 6 (32 bit)
    {0x2020, 0x17, i32, rw, eeprom},          // multi-speed 7 (32 bit)
    {0x2020, 0x09, i16, rw, eeprom},          // multi-speed 0 in rpm
    {0x2020, 0x0A, i16, rw, eeprom},          // multi-speed 1 in rpm
    {0x2020, 0x0B, i16, rw, eeprom},          // multi-speed 2 in rpm
    {0x2020, 0x0C, i16, rw, eeprom},          // multi-speed 3 in rpm
    {0x2020, 0x18, i16, rw, eeprom},          // multi-speed 4 in rpm
    {0x2020, 0x19, i16, rw, eeprom},          // multi-speed 5 in rpm
    {0x2020, 0x1A, i16, rw, eeprom},          // multi-speed 6 in rpm
    {0x2020, 0x1B, i16, rw, eeprom},          // multi-speed 7 in rpm
    {0x2020, 0x0D, i8, rw, eeprom, -4},       // mode while the mode-control input is inactive
    {0x2020, 0x0E, i8, rw, eeprom, -3},       // mode while the mode-control input is active
    {0x2020, 0x0F, u16, rw, eeprom, 0x2F},    // absolute/relative choice for input-driven positioning
    {0x2FF1, 0x01, u8, rw, eeprom, 0, 0, 7},  // segment selector L
    {0x2FF1, 0x02, i16, rw, eeprom},          // position M
    {0x2FF1, 0x03, i16, rw, eeprom},          // position N
    // JD 4.5 windows and limits
    {0x6065, 0x00, u32, rw, eeprom, 10000},         // maximum following error (alarm)
    {0x6067, 0x00, u32, rw, eeprom, 10},            // target-reached window
    {0x607D, 0x01, i32, rw, eeprom},                // software limit positive
    {0x607D, 0x02, i32, rw, eeprom},                // software limit negative
    {0x2FF0, 0x0E, u16, rw, eeprom, 100},           // maximum following error /100
    {0x2508, 0x09, u16, rw, eeprom, 10, 0, 32767},  // target-reached time window
    // JD 4.6 homing
    {0x6098, 0x00, i8, rw, eeprom},           // homing method
    {0x6099, 0x01, u32, rw, eeprom, 546133},  // homing speed while searching the switch
    {0x6099, 0x02, u32, rw, eeprom, 409600},  // homing speed while searching the index
    {0x609A, 0x00, u32, rw, eeprom, 100000},  // homing acceleration
    {0x607C, 0x00, i32, rw, eeprom},          // home offset
    // JD 4.13a errors
    {0x2601, 0x00, u16, ro, ram},             // error word 1
    {0x2602, 0x00, u16, ro, ram},             // error word 2
    {0x2600, 0x00, u16, rw, eeprom, 0xFFFF},  // error mask
    {0x2610, 0x00, u8, ro, ram},              // error history group 0
    {0x2611, 0x00, u8, ro, ram},              // error history group 1
    {0x2612, 0x00, u8, ro, ram},              // error history group 2
    {0x2613, 0x00, u8, ro, ram},              // error history group 3
    {0x2614, 0x00, u8, ro, ram},              // error history group 4
    {0x2615, 0x00, u8, ro, ram},              // error history group 5
    {0x2616, 0x00, u8, ro, ram},              // error history group 6
    {0x2617, 0x00, u8, ro, ram},              // error history group 7
    // JD 4.13b communication settings
    {0x100B, 0x00, u8, rw, eeprom, 1, 1, 127},  // station number (node-ID, Modbus address, RS232 ID)
    {0x2F81, 0x00, u8, rw, eeprom, 50},         // CAN baud code
    {0x2FE0, 0x00, u16, rw, eeprom, 270},       // RS232 baud code
    {0x2FE1, 0x00, u16, rw, ram, 270},          // RS232 baud code, live (debug)
    {0x2FE2, 0x00, u16, rw, eeprom, 540},       // RS485 baud code
    {0x6510, 0x0B, u8, rw, eeprom, 0, 0, 1},    // RS232 multi-drop (cascade)
    // JD 4.13c storing and password
    {0x2FF0, 0x01, u8, rw, ram},      // store / initialise configuration
    {0x2FF0, 0x03, u8, rw, ram},      // store motor parameters
    {0x2FFD, 0x00, u16, rw, eeprom},  // user password
};

}  // namespace

std::span<const ObjectEntry> jd_motion_objects() { return jd_motion_entries; }

}  // namespace axisgate::simulated
