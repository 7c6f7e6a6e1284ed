// What one client makes an axis do: write a parameter, or read an object of the drive through the mailbox.
// Promises one result per call, whatever the gateway answers.
// Never enables an axis.
#pragma once

#include <chrono>
#include <cstdint>

#include "tests/bench/line_protocol.hpp"
#include "tests/bench/modbus_client.hpp"

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

}  // namespace axisgate::bench
