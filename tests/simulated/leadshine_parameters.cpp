// SPDX-License-Identifier: Apache-2.0
// The Pr parameters of the LD2-CAN, 2000h (3.2). Widths are not printed: by the range.
#include "tests/simulated/leadshine_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

constexpr ObjectEntry leadshine_parameter_entries[] = {
    {0x2000, 0x00, u16, rw, eeprom, 0, 0, 2000},        // Pr0.00 model-following bandwidth
    {0x2001, 0x00, u16, rw, eeprom, 8, 0, 8},           // Pr0.01 control mode
    {0x2002, 0x00, u16, rw, eeprom, 0, 0, 2},           // Pr0.02 real-time auto tuning
    {0x2003, 0x00, u16, rw, eeprom, 11, 0, 31},         // Pr0.03 machine stiffness for auto tuning
    {0x2004, 0x00, u16, rw, eeprom, 250, 0, 10000},     // Pr0.04 inertia ratio
    {0x2006, 0x00, u16, rw, eeprom},                    // Pr0.06 running direction
    {0x2007, 0x00, u16, rw, eeprom, 3, 0, 3},           // Pr0.07 touch-probe polarity (reserved)
    {0x2008, 0x00, u32, rw, eeprom},                    // Pr0.08 command pulses per motor revolution
    {0x2013, 0x00, u16, rw, eeprom, 300, 0, 500},       // Pr0.13 1st torque limit
    {0x2014, 0x00, u16, rw, eeprom, 200, 0, 500},       // Pr0.14 excessive position deviation threshold
    {0x2015, 0x00, u16, rw, eeprom, 0, 0, 15},          // Pr0.15 absolute encoder setting
    {0x2016, 0x00, u16, rw, eeprom, 100, 40, 500},      // Pr0.16 regeneration resistor value
    {0x2017, 0x00, u16, rw, eeprom, 20, 20, 5000},      // Pr0.17 regeneration resistor power
    {0x2023, 0x00, u16, rw, eeprom, 2, 0, 127},         // Pr0.23 CAN node ID
    {0x2024, 0x00, u16, rw, eeprom, 1, 0, 7},           // Pr0.24 CAN baud rate
    {0x2025, 0x00, u16, rw, eeprom, 10, 1, 100},        // Pr0.25 sync compensation time 1
    {0x2026, 0x00, u16, rw, eeprom, 50, 1, 2000},       // Pr0.26 sync compensation time 2
    {0x2100, 0x00, u16, rw, eeprom, 320, 0, 30000},     // Pr1.00 1st position loop gain
    {0x2101, 0x00, u16, rw, eeprom, 180, 1, 32767},     // Pr1.01 1st velocity loop gain
    {0x2102, 0x00, u16, rw, eeprom, 310, 1, 10000},     // Pr1.02 1st velocity loop integral time
    {0x2103, 0x00, u16, rw, eeprom, 15, 0, 31},         // Pr1.03 1st velocity detection filter
    {0x2104, 0x00, u16, rw, eeprom, 126, 0, 2500},      // Pr1.04 1st torque filter
    {0x2105, 0x00, u16, rw, eeprom, 380, 0, 30000},     // Pr1.05 2nd position loop gain
    {0x2106, 0x00, u16, rw, eeprom, 180, 1, 32767},     // Pr1.06 2nd velocity loop gain
    {0x2107, 0x00, u16, rw, eeprom, 10000, 1, 10000},   // Pr1.07 2nd velocity loop integral time
    {0x2108, 0x00, u16, rw, eeprom, 15, 0, 31},         // Pr1.08 2nd velocity detection filter
    {0x2109, 0x00, u16, rw, eeprom, 126, 0, 2500},      // Pr1.09 2nd torque filter
    {0x2110, 0x00, u16, rw, eeprom, 300, 0, 1000},      // Pr1.10 velocity feed-forward gain
    {0x2111, 0x00, u16, rw, eeprom, 50, 0, 6400},       // Pr1.11 feed-forward filter time
    {0x2112, 0x00, u16, rw, eeprom, 0, 0, 1000},        // Pr1.12 torque feed-forward gain
    {0x2113, 0x00, u16, rw, eeprom, 0, 0, 6400},        // Pr1.13 torque feed-forward filter time
    {0x2115, 0x00, u16, rw, eeprom, 0, 0, 10},          // Pr1.15 gain switching mode
    {0x2117, 0x00, u16, rw, eeprom, 50, 0, 20000},      // Pr1.17 gain switching level
    {0x2118, 0x00, u16, rw, eeprom, 33, 0, 20000},      // Pr1.18 gain switching hysteresis
    {0x2119, 0x00, u16, rw, eeprom, 33, 0, 10000},      // Pr1.19 gain switching time
    {0x2137, 0x00, u16, rw, eeprom},                    // Pr1.37 special register (alarm masks)
    {0x2138, 0x00, u16, rw, eeprom},                    // Pr1.38 special register 1
    {0x2200, 0x00, u16, rw, eeprom, 0, 0, 4},           // Pr2.00 adaptive filter mode
    {0x2201, 0x00, u16, rw, eeprom, 2000, 50, 2000},    // Pr2.01 1st notch frequency
    {0x2202, 0x00, u16, rw, eeprom, 2, 0, 20},          // Pr2.02 1st notch width
    {0x2203, 0x00, u16, rw, eeprom, 0, 0, 99},          // Pr2.03 1st notch depth
    {0x2204, 0x00, u16, rw, eeprom, 2000, 50, 2000},    // Pr2.04 2nd notch frequency
    {0x2205, 0x00, u16, rw, eeprom, 2, 0, 20},          // Pr2.05 2nd notch width
    {0x2206, 0x00, u16, rw, eeprom, 0, 0, 99},          // Pr2.06 2nd notch depth
    {0x2207, 0x00, u16, rw, eeprom, 2000, 50, 2000},    // Pr2.07 3rd notch frequency
    {0x2214, 0x00, u16, rw, eeprom, 0, 0, 2000},        // Pr2.14 1st damping frequency
    {0x2215, 0x00, u16, rw, eeprom, 0, 0, 2000},        // Pr2.15 2nd damping frequency
    {0x2222, 0x00, u16, rw, eeprom, 0, 0, 32767},       // Pr2.22 position command smoothing filter
    {0x2223, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr2.23 position command FIR filter
    {0x2312, 0x00, u16, rw, eeprom, 100, 0, 10000},     // Pr3.12 acceleration time
    {0x2313, 0x00, u16, rw, eeprom, 100, 0, 10000},     // Pr3.13 deceleration time
    {0x2314, 0x00, u16, rw, eeprom, 0, 0, 1000},        // Pr3.14 S-curve time
    {0x2316, 0x00, u16, rw, eeprom, 30, 10, 2000},      // Pr3.16 zero-speed clamp level
    {0x2323, 0x00, u16, rw, eeprom, 0, 0, 32767},       // Pr3.23 velocity-mode zero hold
    {0x2400, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.00 SI1 input function
    {0x2401, 0x00, u32, rw, eeprom, 1, 0, 16777215},    // Pr4.01 SI2 input function
    {0x2402, 0x00, u32, rw, eeprom, 2, 0, 16777215},    // Pr4.02 SI3 input function
    {0x2403, 0x00, u32, rw, eeprom, 22, 0, 16777215},   // Pr4.03 SI4 input function
    {0x2404, 0x00, u32, rw, eeprom, 7, 0, 16777215},    // Pr4.04 SI5 input function
    {0x2405, 0x00, u32, rw, eeprom, 20, 0, 16777215},   // Pr4.05 SI6 input function
    {0x2406, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.06 SI7 input function
    {0x2407, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.07 SI8 input function
    {0x2408, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.08 SI9 input function
    {0x2409, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.09 SI10 input function
    {0x2444, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.44 SI11 input function
    {0x2445, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.45 SI12 input function
    {0x2446, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.46 SI13 input function
    {0x2447, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.47 SI14 input function
    {0x2410, 0x00, u32, rw, eeprom, 1, 0, 16777215},    // Pr4.10 SO1 output function
    {0x2411, 0x00, u32, rw, eeprom, 2, 0, 16777215},    // Pr4.11 SO2 output function
    {0x2412, 0x00, u32, rw, eeprom, 4, 0, 16777215},    // Pr4.12 SO3 output function
    {0x2413, 0x00, u32, rw, eeprom, 3, 0, 16777215},    // Pr4.13 SO4 output function
    {0x2414, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.14 SO5 output function
    {0x2415, 0x00, u32, rw, eeprom, 0, 0, 16777215},    // Pr4.15 SO6 output function
    {0x2431, 0x00, u16, rw, eeprom, 10, 0, 10000},      // Pr4.31 in-position window
    {0x2432, 0x00, u16, rw, eeprom, 0, 0, 4},           // Pr4.32 in-position output mode
    {0x2433, 0x00, u16, rw, eeprom, 0, 0, 15000},       // Pr4.33 INP hold time
    {0x2434, 0x00, u16, rw, eeprom, 50, 10, 2000},      // Pr4.34 zero speed
    {0x2435, 0x00, u16, rw, eeprom, 50, 10, 2000},      // Pr4.35 speed-coincidence width
    {0x2436, 0x00, u16, rw, eeprom, 1000, 10, 2000},    // Pr4.36 at-speed threshold
    {0x2437, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr4.37 brake release delay (list: action at stop)
    {0x2438, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr4.38 brake early-engage (list: action while running)
    {0x2439, 0x00, u16, rw, eeprom, 30, 30, 3000},      // Pr4.39 brake-release speed threshold
    {0x2443, 0x00, u16, rw, eeprom, 0, 0, 1},           // Pr4.43 E-STOP behaviour
    {0x2504, 0x00, u16, rw, eeprom, 0, 0, 2},           // Pr5.04 over-travel input setting
    {0x2506, 0x00, u16, rw, eeprom, 0, 0, 1},           // Pr5.06 stop mode / sequence at servo-off
    {0x2508, 0x00, u16, rw, eeprom, 1, 0, 1},           // Pr5.08 under-voltage trigger
    {0x2509, 0x00, u16, rw, eeprom, 70, 70, 2000},      // Pr5.09 main-power-off detection time
    {0x2510, 0x00, u16, rw, eeprom, 0, 0, 2},           // Pr5.10 dynamic braking
    {0x2511, 0x00, u16, rw, eeprom, 0, 0, 500},         // Pr5.11 torque limit for immediate stop
    {0x2512, 0x00, u16, rw, eeprom, 0, 0, 115},         // Pr5.12 overload level
    {0x2513, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr5.13 over-speed level
    {0x2515, 0x00, u16, rw, eeprom, 0, 0, 255},         // Pr5.15 I/O input filter
    {0x2520, 0x00, u16, rw, eeprom, 2, 0, 2},           // Pr5.20 position unit for monitoring
    {0x2521, 0x00, u16, rw, eeprom, 0, 0, 2},           // Pr5.21 torque limit source
    {0x2522, 0x00, u16, rw, eeprom, 300, 0, 500},       // Pr5.22 2nd torque limit
    {0x2528, 0x00, u16, rw, eeprom, 34, 0, 42},         // Pr5.28 LED initial display item
    {0x2533, 0x00, u16, rw, eeprom, 0, 0, 32767},       // Pr5.33 probe 1 compensation (reserved)
    {0x2534, 0x00, u16, rw, eeprom, 0, 0, 32767},       // Pr5.34 probe 2 compensation (reserved)
    {0x2535, 0x00, u16, rw, eeprom, 0, 0, 1},           // Pr5.35 front panel lock
    {0x2536, 0x00, u16, rw, eeprom},                    // Pr5.36 enable parameter group 7
    {0x2537, 0x00, u16, rw, eeprom, 500, 0, 5000},      // Pr5.37 torque-saturation detection time
    {0x2539, 0x00, u16, rw, eeprom, 80, 0, 500},        // Pr5.39 3rd torque limit
    {0x2601, 0x00, u16, rw, eeprom, 0, 0, 360},         // Pr6.01 encoder zero compensation
    {0x2604, 0x00, u16, rw, eeprom, 300, 0, 10000},     // Pr6.04 JOG speed
    {0x2605, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr6.05 3rd position gain time
    {0x2606, 0x00, u16, rw, eeprom, 100, 0, 1000},      // Pr6.06 3rd position gain factor
    {0x2607, 0x00, i16, rw, eeprom, 0, -100, 100},      // Pr6.07 torque command offset
    {0x2608, 0x00, i16, rw, eeprom, 0, -100, 100},      // Pr6.08 positive torque compensation
    {0x2609, 0x00, i16, rw, eeprom, 0, -100, 100},      // Pr6.09 negative torque compensation
    {0x2611, 0x00, u16, rw, eeprom, 100, 50, 100},      // Pr6.11 current response
    {0x2612, 0x00, i16, rw, eeprom, 50, -300, 300},     // Pr6.12 encoder zeroing torque limit
    {0x2613, 0x00, u16, rw, eeprom, 0, 0, 10000},       // Pr6.13 2nd inertia ratio
    {0x2614, 0x00, u16, rw, eeprom, 200, 0, 3000},      // Pr6.14 max time for immediate stop at alarm
    {0x2620, 0x00, u16, rw, eeprom, 10, 0, 1200},       // Pr6.20 trial-run distance
    {0x2621, 0x00, u16, rw, eeprom, 100, 0, 30000},     // Pr6.21 trial-run wait time
    {0x2622, 0x00, u16, rw, eeprom, 1, 0, 32767},       // Pr6.22 trial-run cycles
    {0x2625, 0x00, u16, rw, eeprom, 100, 0, 32767},     // Pr6.25 trial-run acceleration
    {0x2626, 0x00, u16, rw, eeprom, 0, 0, 32767},       // Pr6.26 trial-run mode
    {0x2634, 0x00, u16, rw, eeprom, 100, 0, 32767},     // Pr6.34 frame-error window time
    {0x2635, 0x00, u16, rw, eeprom, 50, 0, 32767},      // Pr6.35 frame-error window
    {0x2661, 0x00, u16, rw, eeprom, 10, 0, 1000},       // Pr6.61 z signal hold time
    {0x2662, 0x00, u16, rw, eeprom, 0, 0, 99},          // Pr6.62 overload warning threshold
    {0x2663, 0x00, u16, rw, eeprom, 0, 0, 32766},       // Pr6.63 multi-turn upper limit
    {0x2715, 0x00, u16, rw, eeprom},                    // Pr7.15 motor model code
    {0x2716, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.16 encoder model code
    {0x2728, 0x00, u16, rw, eeprom, 0, 0, 100},         // Pr7.28 reactive pump-up suppression gain
    {0x2730, 0x00, u16, rw, eeprom, 18, 15, 60},        // Pr7.30 under-voltage threshold
    {0x2731, 0x00, u16, rw, eeprom, 0, 0, 1},           // Pr7.31 reactive pump-up suppression
    {0x2732, 0x00, u16, rw, eeprom, 80, 20, 90},        // Pr7.32 regeneration on threshold
    {0x2733, 0x00, u16, rw, eeprom, 5, 1, 50},          // Pr7.33 regeneration hysteresis
    {0x2734, 0x00, u16, rw, eeprom, 0, 0, 100},         // Pr7.34 over-voltage threshold
    {0x2737, 0x00, u16, rw, eeprom, 0, 0, 4096},        // Pr7.37 AI1 hardware offset compensation
    {0x2748, 0x00, u16, rw, eeprom, 18, 15, 48},        // Pr7.48 under-voltage check start point
    {0x2749, 0x00, u16, rw, eeprom, 5000, 100, 30000},  // Pr7.49 under-voltage check start delay
    {0x2775, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.75 SI3 input delay filter
    {0x2776, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.76 SI4 input delay filter
    {0x2777, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.77 SI5 input delay filter
    {0x2778, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.78 SI6 input delay filter
    {0x2779, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.79 SI7 input delay filter
    {0x2780, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.80 SI8 input delay filter
    {0x2781, 0x00, u16, rw, eeprom, 0, 0, 30000},       // Pr7.81 SI9 input delay filter
};

}  // namespace

std::span<const ObjectEntry> leadshine_parameters() { return leadshine_parameter_entries; }

}  // namespace axisgate::simulated
