// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/motor_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace axisgate::bench {
namespace {

using Protocol = MotionProtocol;

constexpr std::string_view kJd = R"("profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5})";
constexpr std::string_view kKeya = R"("profile": "keya-kydas4860-2e", "node": 1)";

constexpr std::array kDrives{
    MotorDrive{"kinco-serial", Protocol::kinco_serial, "jd@1",
               R"("adapter": "kinco-serial", "rs485": "off", "baud": 38400)", false, kJd, 1},
    MotorDrive{"modbus-rtu, iD286pro", Protocol::id286pro_rtu, "rtu:id286pro@1",
               R"("adapter": "modbus-rtu", "rs485": "off", "baud": 115200)", false,
               R"("profile": "id286pro", "node": 1)", 1},
    MotorDrive{"canopen, Kinco JD", Protocol::jd_canopen, "lawicel:jd@1", R"("adapter": "canopen", "bitrate": 500000)",
               true, kJd, 1},
    MotorDrive{"keya-rs232", Protocol::keya_rs232, "keya-rs232", R"("adapter": "keya-rs232", "rs485": "off")", false,
               R"("profile": "keya-kydas4860-2e")", 2},
    MotorDrive{"keya-rs485", Protocol::keya_rs485, "keya-rs485@1", R"("adapter": "keya-rs485", "rs485": "off")", false,
               kKeya, 2},
    MotorDrive{"keya-can", Protocol::keya_can, "lawicel:keya-can@1", R"("adapter": "keya-can", "bitrate": 250000)",
               true, kKeya, 2},
    MotorDrive{"canopen, Keya", Protocol::keya_canopen, "lawicel:keya-kydas4860-2e@1",
               R"("adapter": "canopen", "bitrate": 250000)", true, kKeya, 2},
};

std::string axes_of(const MotorDrive& drive, int first, int lease_ms) {
  std::string axes;
  for (int axis = first; axis < first + drive.axes; ++axis)
    axes +=
        fmt::format(R"({}{{"axis": {}, "lease": {{"timeout_ms": {}}}}})", axis == first ? "" : ", ", axis, lease_ms);
  return axes;
}

}  // namespace

std::span<const MotorDrive> motor_drives() { return kDrives; }

const MotorDrive& motor_drive(MotionProtocol protocol) {
  return *std::ranges::find(kDrives, protocol, &MotorDrive::protocol);
}

MotorStage::MotorStage(const BenchOptions& options, std::vector<MotorDrive> drives, const StageOptions& stage)
    : drives_(std::move(drives)) {
  const auto port_of = [&](std::size_t line) { return fmt::format("{}/drive{}", options.folder, line); };
  std::vector<std::string> simulated;
  for (std::size_t line = 0; line < lines(); ++line)
    simulated.push_back(fmt::format("{}:{}", port_of(line), drive(line).simulated));
  simulator_.emplace(simulated, options.folder + "/simulator");
  std::string buses;
  for (std::size_t line = 0; line < lines(); ++line) {
    const std::string tapped = fmt::format("{}/tapped{}", options.folder, line);
    taps_.push_back(std::make_unique<TappedLine>(tapped, port_of(line), drive(line).protocol));
    buses += fmt::format("{}{{\"name\": \"line{}\", {}, \"device\": \"{}{}\", \"drives\": [{{{}, \"axes\": [{}]}}]}}",
                         line == 0 ? "" : ",\n", line, drive(line).bus, drive(line).lawicel ? "slcan:" : "", tapped,
                         drive(line).drive, axes_of(drive(line), first_axis(line), stage.lease_ms));
  }
  gateway_.emplace(options.program, options.folder, buses, first_axis(lines()) - 1, 0U, stage.listener);
}

int MotorStage::first_axis(std::size_t line) const {
  int axis = 1;
  for (std::size_t before = 0; before < line; ++before) axis += drive(before).axes;
  return axis;
}

std::string MotorStage::ask(std::size_t line, std::string_view word) const {
  return simulator_->ask(fmt::format("{} drive{}/1", word, line));
}

ModbusClient running_axis(std::uint16_t port, int axis) {
  constexpr std::chrono::seconds kPatience{10};
  constexpr int kEnable = 0, kRunVelocity = 7;
  const auto block = static_cast<std::uint16_t>(100 * axis);
  const auto at = [block](int offset) { return static_cast<std::uint16_t>(block + offset); };
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    // A new connection each time: it owns nothing and has written nothing.
    ModbusClient client(port);
    // A coil that moves the axis acts on 1 after a 0 alone; one that enables it does after a stop.
    for (const int coil : {kRunVelocity, kEnable}) static_cast<void>(client.write_coil(at(coil), false));
    const int enabled = client.write_coil(at(kEnable), true);
    const int set = enabled != 0 ? 0 : client.write(at(kTargetVelocityOffset), registers_of(kRunningVelocity));
    const int runs = enabled != 0 || set != 0 ? 0 : client.write_coil(at(kRunVelocity), true);
    if (enabled == 0 && set == 0 && runs == 0) return client;
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error(
          fmt::format("axis {} does not run: enable {}, velocity {}, run {}", axis, enabled, set, runs));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace axisgate::bench
