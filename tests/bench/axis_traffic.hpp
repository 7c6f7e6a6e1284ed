// SPDX-License-Identifier: Apache-2.0
// What one client makes an axis do: write a parameter, or read an object of the drive through the mailbox.
// Promises one result per call, whatever the gateway answers.
// Never enables an axis.
#pragma once

#include <chrono>
#include <cstdint>

#include "tests/bench/busy_clients.hpp"
#include "tests/bench/line_protocol.hpp"
#include "tests/bench/modbus_client.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {

struct DriveObject {
  std::uint16_t index;
  std::uint8_t subindex;
  std::uint8_t size;
};
/// Objects that a Kinco JD can be asked for at any time; the number is taken modulo theirs.
[[nodiscard]] DriveObject readable_object(int number, LineProtocol protocol = LineProtocol::kinco_serial);

/// Writes another value than the last one each time: one it is known to hold would not be sent.
class ParameterWriter {
 public:
  static constexpr int kParameters = 6;
  /// `parameter`: which of them, modulo kParameters.
  ParameterWriter(int axis, int parameter);
  /// The exception code, 0 for none.
  [[nodiscard]] int write(ModbusClient& client);

 private:
  std::uint16_t address_;
  std::uint32_t turn_ = 0;
};

/// Through registers 80 to 88; asks for the result at once, and then again after each pause. True: the drive answered.
[[nodiscard]] bool read_object(ModbusClient& client, int axis, const DriveObject& object,
                               std::chrono::microseconds pause = {});

/// What a busy client does over and over on axis 1.
[[nodiscard]] BusyClients::Turn writing(int parameter);
[[nodiscard]] BusyClients::Turn reading(int number, LineProtocol protocol, std::chrono::microseconds pause);
/// So many clients; the first `writers` of them write, the others read, and do not ask a mailbox again at once: that
/// would measure the Modbus server instead.
[[nodiscard]] std::vector<BusyClients::Turn> readers_and_writers(int clients, int writers, LineProtocol protocol);

/// Milliseconds of each parameter write of axis 1 in `lasting`, each a `pause` or up to two after the one before, so
/// that they keep no step with the polls. Throws std::runtime_error when one is refused.
[[nodiscard]] Samples write_times(std::uint16_t port, std::chrono::milliseconds lasting,
                                  std::chrono::milliseconds pause);

}  // namespace axisgate::bench
