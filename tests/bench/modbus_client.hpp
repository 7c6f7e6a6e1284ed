// SPDX-License-Identifier: Apache-2.0
// A blocking Modbus-TCP client as a plain PLC would be: one request, its reply, the next.
// Promises that every reply belongs to its request, and to give up after 5 s.
// Never retries.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::bench {

class ModbusClient {
 public:
  /// Throws std::runtime_error, as all functions here do when the gateway does not answer.
  explicit ModbusClient(std::uint16_t port);
  ~ModbusClient();
  ModbusClient(ModbusClient&& other) noexcept;
  ModbusClient(const ModbusClient&) = delete;
  ModbusClient& operator=(const ModbusClient&) = delete;
  ModbusClient& operator=(ModbusClient&&) = delete;

  [[nodiscard]] int socket() const { return socket_; }
  /// FC 3. An exception is an error here.
  std::vector<std::uint16_t> read(std::uint16_t address, std::uint16_t count);
  /// FC 16 and FC 5: the exception code, 0 for none.
  [[nodiscard]] int write(std::uint16_t address, std::span<const std::uint16_t> values);
  [[nodiscard]] int write_coil(std::uint16_t address, bool on);
  /// FC 43/13 (CANopen general reference), all bytes of the object. True: the drive answered.
  [[nodiscard]] bool read_object(std::uint8_t node, std::uint16_t index, std::uint8_t sub);
  /// Ends the connection, by its end or by a reset. Nothing may be asked afterwards.
  void close();
  void reset();

 private:
  Bytes ask(std::span<const Byte> pdu);

  int socket_;
  std::uint16_t transaction_ = 0;
  std::vector<Byte> reply_;
};

inline constexpr std::uint16_t kRegisters = 39;  ///< of an axis, from its first on
[[nodiscard]] constexpr std::uint16_t address_of(int axis, int offset) {
  return static_cast<std::uint16_t>(100 * axis + offset);
}
/// A u32 as the gateway wants it.
[[nodiscard]] constexpr std::array<std::uint16_t, 2> registers_of(std::uint32_t value) {
  return {static_cast<std::uint16_t>(value >> 16), static_cast<std::uint16_t>(value & 0xFFFF)};
}

}  // namespace axisgate::bench
