// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/jd_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

// Loop, I/O, analog, motor and power stage: kept as values, without effect on the simulated motion but for 2010.
constexpr ObjectEntry jd_setup_entries[] = {
    // JD 4.7 velocity loop and auto-tuning
    {0x60F9, 0x01, u16, rw, eeprom, 100, 0, 32767},   // velocity loop proportional gain 0
    {0x60F9, 0x02, i16, rw, eeprom, 2, 0, 16384},     // velocity loop integral gain 0
    {0x60F9, 0x03, u8, rw, eeprom, 45, 0, 90},        // notch filter frequency
    {0x60F9, 0x04, u8, rw, eeprom, 0, 0, 1},          // notch filter enable
    {0x60F9, 0x05, i8, rw, eeprom, 7, 0, 45},         // velocity feedback filter
    {0x60F9, 0x06, u8, rw, eeprom, 0, 0, 2},          // velocity feedback mode
    {0x60F9, 0x0B, u16, rw, eeprom, 1000, 0, 32767},  // observer kd
    {0x60F9, 0x0C, u16, rw, eeprom, 1000, 0, 32767},  // observer kp
    {0x60F9, 0x0D, u16, rw, eeprom, 0, 0, 16384},     // observer ki
    {0x60F9, 0x0E, u16, rw, eeprom, 20, 20, 15000},   // observer load parameter
    {0x60F9, 0x10, u16, rw, eeprom, 64, 0, 1000},     // auto-tuning speed amplitude
    {0x60F9, 0x11, u16, rw, eeprom, 128, 0, 16384},   // auto-tuning scale
    {0x60F9, 0x12, u16, rw, eeprom, 64, 1, 1000},     // auto-tuning filter
    {0x2FF0, 0x0A, u16, rw, ram, 58, 0, 600},         // velocity loop bandwidth
    {0x2FF0, 0x0C, u16, rw, ram},                     // auto-tuning start
    // JD 4.8 position loop
    {0x60FB, 0x01, u16, rw, eeprom, 1000, 0, 16384},    // position loop proportional gain 0
    {0x60FB, 0x02, i16, rw, eeprom, 255, 0, 255},       // position loop velocity feed-forward
    {0x60FB, 0x03, i16, rw, eeprom, 32767, 10, 32767},  // position loop acceleration feed-forward
    {0x60FB, 0x05, i16, rw, eeprom, 1, 1, 255},         // smoothing filter
    {0x2FF0, 0x0B, u16, rw, ram, 9},                    // position loop bandwidth
    // JD 4.9 current loop
    {0x60F6, 0x01, u16, rw, eeprom, 100},          // current loop proportional gain
    {0x60F6, 0x02, u16, rw, eeprom, 20},           // current loop integral gain
    {0x60F6, 0x03, u16, rw, eeprom, 10, 0, 1000},  // speed limit factor
    {0x60F6, 0x06, u16, rw, eeprom},               // commutation offset
    // JD 4.10 digital inputs and outputs
    {0x2010, 0x03, u16, rw, eeprom, 0x0001},  // digital input 1 function
    {0x2010, 0x04, u16, rw, eeprom, 0x0002},  // digital input 2 function
    {0x2010, 0x05, u16, rw, eeprom, 0x0004},  // digital input 3 function
    {0x2010, 0x06, u16, rw, eeprom, 0x0008},  // digital input 4 function
    {0x2010, 0x07, u16, rw, eeprom, 0x0010},  // digital input 5 function
    {0x2010, 0x08, u16, rw, eeprom, 0x0020},  // digital input 6 function
    {0x2010, 0x09, u16, rw, eeprom, 0x0040},  // digital input 7 function
    {0x2010, 0x1D, u16, rw, eeprom},          // digital input 8 function
    {0x2010, 0x0F, u16, rw, eeprom, 0x0001},  // digital output 1 function
    {0x2010, 0x10, u16, rw, eeprom, 0x0000},  // digital output 2 function
    {0x2010, 0x11, u16, rw, eeprom, 0x00A4},  // digital output 3 function
    {0x2010, 0x12, u16, rw, eeprom, 0x0008},  // digital output 4 function
    {0x2010, 0x13, u16, rw, eeprom, 0x0000},  // digital output 5 function
    {0x2010, 0x1E, u16, rw, eeprom, 0x0010},  // digital output 6 function
    {0x2010, 0x1F, u16, rw, eeprom, 0x0002},  // digital output 7 function
    {0x2010, 0x0A, u16, ro, ram},             // digital input state
    {0x2010, 0x14, u16, ro, ram},             // digital output state
    {0x2010, 0x01, u16, rw, eeprom, 0xFF},    // input polarity
    {0x2010, 0x0D, u16, rw, eeprom, 0x7F},    // output polarity
    {0x2010, 0x02, u16, rw, ram},             // input simulation
    {0x2010, 0x0E, u16, rw, ram},             // output simulation (force)
    {0x2010, 0x0C, u16, ro, ram},             // system input state
    {0x2010, 0x16, u16, ro, ram},             // system output state
    {0x2FF0, 0x0D, u16, rw, ram},             // simplified IO polarity
    {0x2FF0, 0x08, u16, rw, ram},             // simplified IO simulation
    // JD 4.11 analog inputs
    {0x2502, 0x01, u16, rw, eeprom, 5, 1, 127},       // analog 1 filter
    {0x2502, 0x02, u16, rw, eeprom, 0, 0, 8192},      // analog 1 dead band
    {0x2502, 0x03, i16, rw, eeprom, 0, -8192, 8192},  // analog 1 offset
    {0x2502, 0x04, u16, rw, eeprom, 5, 1, 127},       // analog 2 filter
    {0x2502, 0x05, u16, rw, eeprom, 0, 0, 8192},      // analog 2 dead band
    {0x2502, 0x06, i16, rw, eeprom, 0, -8192, 8192},  // analog 2 offset
    {0x2502, 0x07, u8, rw, eeprom, 0, 0, 27},         // analog speed channel
    {0x2502, 0x0A, i16, rw, eeprom, 1000},            // analog speed factor
    {0x2502, 0x08, u8, rw, eeprom, 0, 0, 2},          // analog torque channel
    {0x2502, 0x0B, i16, rw, eeprom, 1000},            // analog torque factor
    {0x2502, 0x09, u8, rw, eeprom, 0, 0, 2},          // analog maximum-torque channel
    {0x2502, 0x0C, i16, rw, eeprom, 8192},            // analog maximum-torque factor
    // JD 4.12 pulse input and electronic gear
    {0x2508, 0x01, i16, rw, eeprom, 1000, -32767, 32767},  // electronic gear numerator 0
    {0x2508, 0x02, u16, rw, eeprom, 1000, 1, 32767},       // electronic gear denominator 0
    {0x2508, 0x03, i8, rw, eeprom, 1, 0, 12},              // pulse mode
    {0x2508, 0x04, i32, rw, ram},                          // pulses before the gear
    {0x2508, 0x05, i32, rw, ram},                          // pulses after the gear
    {0x2508, 0x06, u16, rw, eeprom, 3, 1, 32767},          // pulse filter
    {0x2508, 0x08, u16, rw, eeprom, 600, 0, 600},          // pulse input frequency limit
    {0x2508, 0x0C, i16, rw, ram},                          // pulse speed before the gear
    {0x2508, 0x0D, i16, rw, ram},                          // pulse speed after the gear
    // JD 4.14a motor parameters: kept by 2FF0:03
    {0x6410, 0x01, u16, rw, motor},              // motor model (not normally used)
    {0x6410, 0x02, u8, rw, motor, 0x11},         // encoder type
    {0x6410, 0x05, u8, rw, motor, 3},            // motor pole pairs
    {0x6410, 0x06, u8, rw, motor},               // commutation mode
    {0x6410, 0x07, u16, rw, motor},              // commutation current
    {0x6410, 0x08, u16, rw, motor},              // commutation delay
    {0x6410, 0x09, u16, rw, motor},              // motor Iit current
    {0x6410, 0x0A, u16, rw, motor},              // motor Iit time
    {0x6410, 0x0B, u16, rw, motor},              // motor maximum current
    {0x6410, 0x0C, u16, rw, motor},              // phase inductance
    {0x6410, 0x0D, u8, rw, motor},               // phase resistance
    {0x6410, 0x0E, u16, rw, motor},              // back EMF constant
    {0x6410, 0x0F, u16, rw, motor},              // torque constant
    {0x6410, 0x10, u16, rw, motor},              // rotor inertia
    {0x6410, 0x11, u16, rw, motor, 0, 0, 2500},  // brake duty cycle
    {0x6410, 0x12, u16, rw, motor, 150},         // brake delay
    {0x6410, 0x13, u8, rw, motor},               // motor rotation direction
    {0x6410, 0x14, u16, rw, motor, 0x304B},      // motor model to configure
    {0x6410, 0x16, u16, ro, ram, 0x304B},        // motor model in use
    // JD 4.14b drive parameters
    {0x60F7, 0x01, u16, rw, eeprom},       // brake resistor value
    {0x60F7, 0x02, u16, rw, eeprom},       // brake resistor rated power
    {0x60F7, 0x03, u16, rw, eeprom, 60},   // brake resistor time constant
    {0x60F7, 0x05, u16, rw, eeprom, 150},  // inrush relay time
    {0x2501, 0x01, i16, rw, eeprom},       // U phase current offset
    {0x2501, 0x02, i16, rw, eeprom},       // V phase current offset
    {0x3000, 0x01, u16, rw, eeprom},       // bus voltage calibration 1
    {0x3000, 0x02, u16, rw, eeprom},       // bus voltage calibration 2
    {0x2FF0, 0x04, u8, rw, eeprom, 25},    // panel display selection
};

}  // namespace

std::span<const ObjectEntry> jd_setup_objects() { return jd_setup_entries; }

}  // namespace axisgate::simulated
