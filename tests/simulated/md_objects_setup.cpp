// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/md_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

// DIN functions at delivery stand in a lost figure (MD 12.9): DIN1 enable and DIN3 mode control are assumed, since MD
// 4.5 tells the user to remove both before a bus is used.
constexpr ObjectEntry md_setup_entries[] = {
    // MD D multi-segment position and speed
    {0x2020, 0x01, i32, rw, eeprom},  // multi-segment position 0
    {0x2020, 0x02, i32, rw, eeprom},  // multi-segment position 1
    {0x2020, 0x03, i32, rw, eeprom},  // multi-segment position 2
    {0x2020, 0x04, i32, rw, eeprom},  // multi-segment position 3
    {0x2020, 0x10, i32, rw, eeprom},  // multi-segment position 4
    {0x2020, 0x11, i32, rw, eeprom},  // multi-segment position 5
    {0x2020, 0x12, i32, rw, eeprom},  // multi-segment position 6
    {0x2020, 0x13, i32, rw, eeprom},  // multi-segment position 7
    {0x2020, 0x05, i32, rw, eeprom},  // multi-segment (DIN) speed 0
    {0x2020, 0x06, i32, rw, eeprom},  // multi-segment (DIN) speed 1
    {0x2020, 0x07, i32, rw, eeprom},  // multi-segment (DIN) speed 2
    {0x2020, 0x08, i32, rw, eeprom},  // multi-segment (DIN) speed 3
    {0x2020, 0x14, i32, rw, eeprom},  // multi-segment (DIN) speed 4
    {0x2020, 0x15, i32, rw, eeprom},  // multi-segment (DIN) speed 5
    {0x2020, 0x16, i32, rw, eeprom},  // multi-segment (DIN) speed 6
    {0x2020, 0x17, i32, rw, eeprom},  // multi-segment (DIN) speed 7
    // MD G speed loop: printed without S, so a restart loses Kvp, Kvi and the filter
    {0x60F9, 0x01, u16, rw, ram, 100, 1, 32767},   // speed loop proportional gain [0] (Kvp)
    {0x60F9, 0x02, u16, rw, ram, 2, 0, 1023},      // speed loop integral gain [0] (Kvi)
    {0x60F9, 0x03, u8, rw, eeprom, 45, 0, 90},     // notch filter frequency (Notch_N)
    {0x60F9, 0x04, u8, rw, eeprom, 0, 0, 1},       // notch filter switch (Notch_On)
    {0x60F9, 0x05, u8, rw, ram, 7, 0, 45},         // speed feedback filter (Speed_Fb_N)
    {0x60F9, 0x06, u8, rw, eeprom, 1},             // speed feedback mode
    {0x60F9, 0x07, u16, rw, eeprom, 0, 0, 32767},  // speed loop integral gain / 32
    {0x60F9, 0x08, u32, rw, eeprom, 0, 0, 32768},  // speed loop integral limit
    {0x60F9, 0x15, u8, rw, eeprom, 1, 1, 127},     // output (torque) filter
    // MD H position loop
    {0x60FB, 0x01, u16, rw, eeprom, 10, 0, 327},       // position loop proportional gain [0] (Kpp)
    {0x60FB, 0x02, u16, rw, eeprom, 100, 0, 100},      // velocity feed-forward
    {0x60FB, 0x03, u16, rw, eeprom, 32767, 0, 32767},  // acceleration feed-forward (K_Acc_FF)
    {0x60FB, 0x05, u16, rw, eeprom, 1, 1, 255},        // smoothing filter (Pos_Filter_N)
    {0x3040, 0x07, u16, rw, eeprom, 1},                // load factor
    // MD I digital inputs and outputs
    {0x2010, 0x03, u16, rw, eeprom, 0x0001},  // digital input 1 function
    {0x2010, 0x04, u16, rw, eeprom, 0x0002},  // digital input 2 function
    {0x2010, 0x05, u16, rw, eeprom, 0x0004},  // digital input 3 function
    {0x2010, 0x06, u16, rw, eeprom},          // digital input 4 function
    {0x2010, 0x0F, u16, rw, eeprom, 0x0001},  // digital output 1 function
    {0x2010, 0x10, u16, rw, eeprom, 0x0002},  // digital output 2 function
    {0x2010, 0x0A, u16, ro, ram},             // input port state (pins)
    {0x2010, 0x14, u16, ro, ram},             // output port state
    {0x2010, 0x01, u16, rw, eeprom, 0xFF},    // input polarity
    {0x2010, 0x0D, u16, rw, eeprom, 0x1F},    // output polarity
    {0x2010, 0x02, u16, rw, ram},             // input simulation
    {0x2010, 0x0E, u16, rw, ram},             // output simulation (forces outputs)
    // MD J pulse input and gear
    {0x2508, 0x01, i16, rw, eeprom, 1000},         // electronic gear numerator 0
    {0x2508, 0x02, u16, rw, eeprom, 1000},         // electronic gear denominator 0
    {0x2508, 0x03, u8, rw, eeprom, 1, 0, 2},       // pulse mode
    {0x2508, 0x04, i16, rw, ram},                  // pulses before gear
    {0x2508, 0x05, i16, rw, ram},                  // pulses after gear
    {0x2508, 0x06, u16, rw, eeprom, 3},            // pulse filter
    {0x2508, 0x08, u16, rw, eeprom, 500, 0, 500},  // pulse frequency control (alarm limit)
    {0x2508, 0x0C, i16, ro, ram},                  // pulse frequency before gear
    {0x2508, 0x0D, i16, rw, ram},                  // pulse frequency after gear
    // MD N communication settings
    {0x100B, 0x00, u8, rw, eeprom, 1, 1, 127},  // station number (node ID)
    {0x2FE0, 0x00, u16, rw, eeprom, 270},       // RS232 baud rate
    {0x2FE2, 0x00, u16, rw, eeprom, 540},       // RS485 baud rate
    {0x6510, 0x0B, u8, rw, eeprom},             // RS232 cascade (multi-drop) switch
    {0x6510, 0x0C, u8, rw, eeprom, 1, 0, 1},    // RS485 protocol
    {0x6510, 0x0E, u16, ro, ram, 0x0008},       // RS485 mode
    {0x2F81, 0x00, u8, rw, eeprom, 50},         // CAN baud rate
    {0x1005, 0x00, u32, rw, eeprom, 0x80},      // SYNC COB-ID
    {0x100C, 0x00, u16, rw, eeprom, 1000},      // guard time
    {0x100D, 0x00, u8, rw, eeprom, 3},          // life time factor
    {0x100E, 0x00, u32, rw, eeprom, 0x701},     // node guarding COB-ID
    {0x1014, 0x00, u32, rw, eeprom, 0x81},      // EMCY COB-ID
    {0x1017, 0x00, u16, rw, eeprom},            // heartbeat producer time
    {0x3011, 0x01, u8, rw, eeprom, 2, 0, 4},    // ECAN sync cycle
    {0x3011, 0x02, u8, rw, eeprom, 0, 0, 1},    // ECAN sync clock mode
    {0x3011, 0x04, u16, ro, ram},               // ECAN sync loss counter
    {0x6007, 0x00, u16, rw, eeprom, 0, 0, 1},   // CAN communication loss reaction
    // MD O power stage and motor
    {0x6510, 0x03, u16, ro, ram, 36},  // drive peak current (Imax)
    {0x6510, 0x08, u16, rw, ram, 73},  // braking chopper voltage
    {0x60F7, 0x01, u16, rw, ram},      // braking resistor resistance
    {0x60F7, 0x02, u16, rw, ram},      // braking resistor power
    {0x6410, 0x01, u16, rw, motor},    // motor type
};

}  // namespace

std::span<const ObjectEntry> md_setup_objects() { return md_setup_entries; }

}  // namespace axisgate::simulated
