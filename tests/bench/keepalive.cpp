// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/bench/benches.hpp"
#include "tests/bench/busy_clients.hpp"
#include "tests/bench/motor_stage.hpp"

namespace axisgate::bench {
namespace {

using std::chrono::milliseconds;
constexpr int kAxes = 2;
constexpr double kBoundMs = 500;

/// What the clients write: nothing, the speeds that the drive holds already (which are not sent, so that only the
/// keep-alive commands the motors), or other speeds each time.
enum class Load : std::uint8_t { none, same_speeds, new_speeds };
constexpr std::array<std::string_view, 3> kLoads{"the owner alone", "32, same speeds", "32, new speeds"};

struct Speed {
  std::uint16_t index;
  std::uint8_t sub;
};
/// Where each protocol has motor A's speed: an object that can be asked for at any time.
Speed speed_object(MotionProtocol protocol) {
  if (protocol == MotionProtocol::keya_can) return {0x2103, 1};
  return protocol == MotionProtocol::keya_canopen ? Speed{0x2012, 0} : Speed{0x2102, 0};
}

constexpr std::uint32_t kOtherSpeed = 10'000;  // more, in 1/1000 rpm

/// Half of them write, half make the drive be asked; all read, and each turns from one axis to the other.
void add_busy_clients(BusyClients& clients, MotionProtocol protocol, Load load) {
  for (int i = 0; i < kBusyClients; ++i)
    clients.add([i, load, protocol, turn = 0U](ModbusClient& client) mutable {
      const int axis = 1 + static_cast<int>(++turn % kAxes);
      static_cast<void>(client.read(address_of(axis, 0), kRegisters));
      if (i % 2 != 0) {
        const Speed object = speed_object(protocol);
        static_cast<void>(client.read_object(static_cast<std::uint8_t>(axis), object.index, object.sub));
        return;
      }
      const std::uint32_t more = load == Load::new_speeds ? kOtherSpeed * (turn / kAxes % 2) : 0;
      static_cast<void>(client.write(address_of(axis, kTargetVelocityOffset), registers_of(kRunningVelocity + more)));
    });
}

/// Milliseconds between commands to one of these motors, and the silence at the end where it is beyond the bound: a
/// motor that gets no more commands has no gap with two ends.
std::vector<double> gaps_of(const std::vector<TappedCommand>& commands, std::uint8_t motors,
                            std::chrono::nanoseconds end) {
  std::vector<double> gaps;
  std::optional<std::chrono::nanoseconds> last;
  for (const TappedCommand& it : commands) {
    if ((it.command.motors & motors) == 0) continue;
    if (last) gaps.push_back(std::chrono::duration<double, std::milli>(it.at - *last).count());
    last = it.at;
  }
  const double silence = last ? std::chrono::duration<double, std::milli>(end - *last).count() : 0;
  if (silence > kBoundMs) gaps.push_back(silence);
  return gaps;
}

void measure(const BenchOptions& options, MotorStage& stage, Load load) {
  const milliseconds lasting(options.quick ? 1000 : 30'000);
  constexpr milliseconds kGettingGoing{100};
  BusyClients clients(stage.port());
  // The owner's own reads, which keep both leases alive when nobody else does.
  clients.add([](ModbusClient& client) {
    constexpr milliseconds kBetweenReads{100};
    for (int axis = 1; axis <= kAxes; ++axis) static_cast<void>(client.read(address_of(axis, 0), kRegisters));
    std::this_thread::sleep_for(kBetweenReads);
  });
  if (load != Load::none) add_busy_clients(clients, stage.drive(0).protocol, load);
  std::this_thread::sleep_for(kGettingGoing);
  const auto began = steady_now();
  std::this_thread::sleep_for(lasting);
  const auto ended = steady_now();
  const auto commands = stage.tap(0).since(began);
  clients.stop();
  const auto gaps = gaps_of(commands, kFirstMotor | kSecondMotor, ended);
  double worst_of_one = 0;
  for (const std::uint8_t motor : {kFirstMotor, kSecondMotor})
    worst_of_one = std::max(worst_of_one, quantile(gaps_of(commands, motor, ended), 1));
  // Each is due one at half of its 300 ms.
  const std::string what = fmt::format("{}, {}", stage.drive(0).name, kLoads[static_cast<std::size_t>(load)]);
  options.report.row(what + ": median gap, ms", median(gaps), Beside{"due", 150});
  options.report.row(what + ": worst gap of one motor, ms", worst_of_one, Beside{"bound", kBoundMs});
  if (const std::string trips = stage.ask(0, "trips"); trips != "0")
    throw std::runtime_error(fmt::format("{}: the drive tripped, {} times", what, trips));
}

}  // namespace

void keepalive(const BenchOptions& options) {
  stay_on_processor(1);
  for (const MotionProtocol protocol :
       {MotionProtocol::keya_rs232, MotionProtocol::keya_can, MotionProtocol::keya_canopen}) {
    // One owner for all connections, so that 32 of them may write.
    MotorStage stage(options, {motor_drive(protocol)}, {2000, R"("client": "address")"});
    std::vector<ModbusClient> owners;
    for (int axis = 1; axis <= kAxes; ++axis) owners.push_back(running_axis(stage.port(), axis));
    for (const Load load : {Load::none, Load::same_speeds, Load::new_speeds}) measure(options, stage, load);
  }
}

}  // namespace axisgate::bench
