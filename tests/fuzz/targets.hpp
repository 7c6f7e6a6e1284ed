// SPDX-License-Identifier: Apache-2.0
// What is fuzzed: one small function for each decoder, with bytes that may be anything, and a table of all of them.
// Promises that a function ends for any bytes, gives 0, and throws FuzzFault where the code it plays with broke a
// promise. Never opens a device, but a pseudo-terminal of its own, or a socket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace axisgate::fuzz {

/// A promise was broken: its words.
class FuzzFault : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

inline void must(bool kept, const char* promise) {
  if (!kept) throw FuzzFault(promise);
}

}  // namespace axisgate::fuzz

// Names and signatures are libFuzzer's (tests/fuzz/run); each has its corpus in tests/fuzz/corpus.
int axisgate_fuzz_modbus_wire(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_modbus_session(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_arbiter(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_canopen(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_keya_can(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_keya_rs232(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_keya_rs485(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_kinco(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_modbus_rtu(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_lawicel(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_dds_records(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_profile(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_configuration(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_eds(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_command_line(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_modbus_port(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_scan(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_serial_scan(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_hand_replies(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_top_table(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_can_errors(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_dds_command_line(const std::uint8_t* data, std::size_t size);
int axisgate_fuzz_web_requests(const std::uint8_t* data, std::size_t size);

namespace axisgate::fuzz {

struct Target {
  const char* name;
  int (*run)(const std::uint8_t* data, std::size_t size);
};

inline constexpr std::array kTargets{
    Target{"modbus_wire", axisgate_fuzz_modbus_wire},
    Target{"modbus_session", axisgate_fuzz_modbus_session},
    Target{"arbiter", axisgate_fuzz_arbiter},
    Target{"canopen", axisgate_fuzz_canopen},
    Target{"keya_can", axisgate_fuzz_keya_can},
    Target{"keya_rs232", axisgate_fuzz_keya_rs232},
    Target{"keya_rs485", axisgate_fuzz_keya_rs485},
    Target{"kinco", axisgate_fuzz_kinco},
    Target{"modbus_rtu", axisgate_fuzz_modbus_rtu},
    Target{"lawicel", axisgate_fuzz_lawicel},
    Target{"dds_records", axisgate_fuzz_dds_records},
    Target{"profile", axisgate_fuzz_profile},
    Target{"configuration", axisgate_fuzz_configuration},
    Target{"eds", axisgate_fuzz_eds},
    Target{"command_line", axisgate_fuzz_command_line},
    Target{"modbus_port", axisgate_fuzz_modbus_port},
    Target{"scan", axisgate_fuzz_scan},
    Target{"serial_scan", axisgate_fuzz_serial_scan},
    Target{"hand_replies", axisgate_fuzz_hand_replies},
    Target{"top_table", axisgate_fuzz_top_table},
    Target{"can_errors", axisgate_fuzz_can_errors},
    Target{"dds_command_line", axisgate_fuzz_dds_command_line},
    Target{"web_requests", axisgate_fuzz_web_requests},
};

}  // namespace axisgate::fuzz
