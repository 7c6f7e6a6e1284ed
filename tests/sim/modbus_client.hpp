// A Modbus-TCP client of the simulated world: asks at random, keeps count of what it asked, and checks every reply's
// order. Promises that what it does follows from its generator alone, and that each set-point it writes has a value
// never used before. Never looks into the gateway: it has bytes and nothing else.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/random.hpp"
#include "gateway/upstream/modbus_tcp/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/session.hpp"

namespace axisgate::test {

/// FNV-1a, one value on.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001B3U;
}

/// What the clients have asked for, for those who check.
struct Asked {
  struct Enable {
    Instant at;
    AxisNumber axis;
  };
  std::deque<Enable> enables;
  /// What may move an axis: commands 6, 7, 8 and 10, and target_velocity, which the iD286pro takes with a command.
  struct Motion {
    Instant at;
    AxisNumber axis;
    std::uint16_t command;  ///< kVelocityWritten: target_velocity
  };
  static constexpr std::uint16_t kVelocityWritten = 0;
  std::deque<Motion> motions;
  std::uint64_t starts = 0;  ///< move commands
  std::uint64_t requests = 0;
  std::uint64_t replies = 0;
  std::uint32_t next_unique = 1;  ///< profile_velocity values, 0.001 rpm, each used once
};

/// What a client's programmer knows of an axis.
struct ClientAxis {
  AxisNumber number = 0;
  std::vector<std::uint16_t> homing_methods{35};
  std::uint16_t an_object = 0x6041;  ///< that the drive has, of two bytes
  bool wears = false;                ///< homing method and position limits are kept in memory that wears out
  bool has_name = false;             ///< a name of more than four bytes can be read from it (1008h)
};

class ModbusClient {
 public:
  ModbusClient(const modbus_tcp::SessionContext& context, Runtime& runtime, std::uint64_t seed, std::uint16_t port,
               std::vector<ClientAxis> axes, Asked& asked, std::function<void(std::string)> violated);
  ~ModbusClient();

  /// When it wants to act next.
  [[nodiscard]] Instant next_action() const { return next_action_; }
  void act();
  /// Stops every axis, as an operator at the end of the day does, and asks nothing more.
  void retire();
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  [[nodiscard]] bool waiting() const { return !expected_.empty(); }

 private:
  void connect();
  void disconnect();
  void send(std::vector<Byte> pdu);
  void write(AxisNumber axis, std::uint16_t offset, const std::vector<std::uint16_t>& registers);
  void ask_something();
  void ask_rarely(const ClientAxis& axis);
  void raw_controlword(AxisNumber axis);
  void read_name(AxisNumber axis);
  void command(AxisNumber axis, std::uint16_t number);
  void receive();
  void take_reply(Bytes adu);

  modbus_tcp::SessionContext context_;
  Runtime& runtime_;
  Random random_;
  modbus_tcp::Peer peer_;
  std::vector<ClientAxis> axes_;
  Asked& asked_;
  std::function<void(std::string)> violated_;
  std::unique_ptr<modbus_tcp::Session> session_;
  std::unique_ptr<Timer> timer_;
  std::vector<Byte> incoming_;
  struct Expected {
    std::uint16_t transaction;
    Byte function;
  };
  std::deque<Expected> expected_;
  std::uint16_t transaction_ = 0;
  std::uint16_t command_id_ = 0;
  bool retired_ = false;
  std::size_t stopped_ = 0;  ///< axes, in retirement
  bool in_session_ = false;
  Instant next_action_;
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

}  // namespace axisgate::test
