// SPDX-License-Identifier: Apache-2.0
// With what a program of the gateway's own ends, so that the gateway can say why and try again as often as it makes
// sense. Promises that the numbers never change within one installation; 64 and 70 are those of sysexits.h. Never says
// more than the program knows: an end by a signal has no code.
#pragma once

namespace axisgate::link {

inline constexpr int kExitGatewayGone = 0;  ///< the socket was closed: nobody is left to work for
inline constexpr int kExitUsage = 64;       ///< the command line: will be the same next time
inline constexpr int kExitInternal = 70;    ///< what should not happen
/// What it is there for cannot be begun: DDS: no participant or topic, a port, the QoS file; web: an address that is
/// in use, or without rights.
inline constexpr int kExitCannotServe = 71;
inline constexpr int kExitProtocol = 72;   ///< a packet that is no record: two versions of the programs
inline constexpr int kExitMemory = 73;     ///< its memory limit
inline constexpr int kExitNoAddress = 74;  ///< an address of its configuration is not this computer's: it may come late

}  // namespace axisgate::link
