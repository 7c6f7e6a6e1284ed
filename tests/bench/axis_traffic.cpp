// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/axis_traffic.hpp"

#include <array>
#include <random>
#include <stdexcept>
#include <thread>

#include "tests/bench/exchange_tap.hpp"

namespace axisgate::bench {
namespace {

// profile_velocity, profile_acceleration, profile_deceleration, homing_speed_switch, _zero, homing_acceleration
constexpr std::array<std::uint16_t, ParameterWriter::kParameters> kOffsets{48, 50, 52, 62, 64, 66};

/// The same object on all protocols; CANopen has the index and sub-index of the serial one.
struct Readable {
  DriveObject serial;
  std::uint16_t rtu;  ///< register
};
constexpr std::array<Readable, 16> kObjects{{{{0x6041, 0, 2}, 0x3200},
                                             {{0x6063, 0, 4}, 0x3700},
                                             {{0x606C, 0, 2}, 0x3B00},
                                             {{0x6078, 0, 2}, 0x3E00},
                                             {{0x60FD, 0, 4}, 0x6D00},
                                             {{0x2010, 0x0A, 2}, 0x08A0},
                                             {{0x2010, 0x14, 2}, 0x0940},
                                             {{0x2601, 0, 2}, 0x1F00},
                                             {{0x607C, 0, 4}, 0x4100},
                                             {{0x607A, 0, 4}, 0x4000},
                                             {{0x6081, 0, 4}, 0x4A00},
                                             {{0x6083, 0, 4}, 0x4B00},
                                             {{0x6084, 0, 4}, 0x4C00},
                                             {{0x60FF, 0, 4}, 0x6F00},
                                             {{0x6073, 0, 2}, 0x3D00},
                                             {{0x6080, 0, 2}, 0x4900}}};

}  // namespace

DriveObject readable_object(int number, LineProtocol protocol) {
  const Readable& object = kObjects[static_cast<std::size_t>(number) % kObjects.size()];
  if (protocol != LineProtocol::modbus_rtu) return object.serial;
  return {object.rtu, 0, object.serial.size};
}

ParameterWriter::ParameterWriter(int axis, int parameter)
    : address_(address_of(axis, kOffsets[static_cast<std::size_t>(parameter % kParameters)])) {}

int ParameterWriter::write(ModbusClient& client) {
  return client.write(address_, registers_of(100'000 + 10'000 * (turn_++ % 2)));
}

bool read_object(ModbusClient& client, int axis, const DriveObject& object, std::chrono::microseconds pause) {
  constexpr std::uint16_t kRead = 1, kBusy = 1, kDone = 2;
  const std::array<std::uint16_t, 4> request{kRead, object.index, object.subindex, object.size};
  if (client.write(address_of(axis, 80), request) != 0) return false;
  for (;;) {
    const std::uint16_t status = client.read(address_of(axis, 84), 3)[2];
    if (status != kBusy) return status == kDone;
    if (pause.count() > 0) std::this_thread::sleep_for(pause);
  }
}

BusyClients::Turn writing(int parameter) {
  return [writer = ParameterWriter(1, parameter)](ModbusClient& client) mutable {
    static_cast<void>(writer.write(client));
  };
}

BusyClients::Turn reading(int number, LineProtocol protocol, std::chrono::microseconds pause) {
  return [object = readable_object(number, protocol), pause](ModbusClient& client) {
    static_cast<void>(read_object(client, 1, object, pause));
  };
}

std::vector<BusyClients::Turn> readers_and_writers(int clients, int writers, LineProtocol protocol) {
  constexpr std::chrono::milliseconds kAskAgain{20};
  std::vector<BusyClients::Turn> turns;
  for (int i = 0; i < clients; ++i) turns.push_back(i < writers ? writing(i) : reading(i, protocol, kAskAgain));
  return turns;
}

Samples write_times(std::uint16_t port, std::chrono::milliseconds lasting, std::chrono::milliseconds pause) {
  ModbusClient client(port);
  ParameterWriter writer(1, 0);
  std::minstd_rand random(1);
  std::uniform_int_distribution<int> pauses(1000 * static_cast<int>(pause.count()),
                                            2000 * static_cast<int>(pause.count()));
  Samples milliseconds;
  for (const auto end = SteadyClock::now() + lasting; SteadyClock::now() < end;) {
    std::this_thread::sleep_for(std::chrono::microseconds(pauses(random)));
    const auto began = SteadyClock::now();
    if (writer.write(client) != 0) throw std::runtime_error("a write was refused");
    milliseconds.push_back(std::chrono::duration<double, std::milli>(SteadyClock::now() - began).count());
  }
  return milliseconds;
}

}  // namespace axisgate::bench
