// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/host_commands.hpp"

#include <charconv>
#include <span>
#include <string_view>
#include <vector>

#include "tests/bench/lawicel_lines.hpp"
#include "tests/bench/rtu_requests.hpp"
#include "tests/simulated/frame_receiver.hpp"
#include "tests/simulated/keya_frame.hpp"
#include "tests/simulated/lawicel_text.hpp"

namespace axisgate::bench {
namespace {

using simulated::Time;
using OctetView = std::span<const std::uint8_t>;

constexpr std::uint16_t kControlword = 0x6040, kTargetVelocity = 0x60FF;  // CiA 402

/// Any controlword but one that lets the drive run (CiA 402-2: bits 0 to 3 set, halt not) stops it; so does speed 0.
std::optional<HostCommand> cia402_command(std::uint16_t index, std::uint32_t value) {
  constexpr std::uint32_t kRunBits = 0x10F, kRun = 0x00F;
  if (index == kControlword) return HostCommand{kFirstMotor, (value & kRunBits) == kRun ? std::uint8_t{} : kFirstMotor};
  if (index == kTargetVelocity) return HostCommand{kFirstMotor, value == 0 ? kFirstMotor : std::uint8_t{}};
  return std::nullopt;
}

class KincoCommands final : public HostCommands {
 public:
  std::optional<HostCommand> take(std::uint8_t byte, Time now) override {
    const auto frame = receiver_.receive(byte, now);
    if (!frame || simulated::command_of(*frame) == simulated::FrameCommand::read) return std::nullopt;
    return cia402_command(simulated::index_of(*frame), simulated::data_of(*frame));
  }

 private:
  simulated::FrameReceiver receiver_;
};

class Id286proCommands final : public HostCommands {
 public:
  std::optional<HostCommand> take(std::uint8_t byte, Time now) override {
    const auto frame = requests_.take(byte, now);
    if (!frame || frame->pdu[0] == simulated::function::read) return std::nullopt;
    const auto request = simulated::register_request(frame->pdu);
    if (!request || request->start != kControl || request->values.empty()) return std::nullopt;
    const std::uint16_t order = request->values.front();
    return HostCommand{kFirstMotor, order == kSlowDown || order == kEmergencyStop ? kFirstMotor : std::uint8_t{}};
  }

 private:
  static constexpr std::uint16_t kControl = 323, kSlowDown = 6, kEmergencyStop = 7;
  RtuRequests requests_;
};

class KeyaSerialCommands final : public HostCommands {
 public:
  /// On RS485 a node comes before the enable code, and the values follow at once (manual, RS232 and RS485 frames).
  explicit KeyaSerialCommands(bool rs485) : code_(rs485 ? 2 : 1), values_(rs485 ? 3 : 4) {}

  std::optional<HostCommand> take(std::uint8_t byte, Time now) override {
    constexpr std::size_t kValueSize = 4;
    const auto frame = receiver_.receive(byte, now);
    if (!frame || frame->front() != simulated::keya_start::control) return std::nullopt;
    const OctetView bytes(*frame);
    HostCommand command{kFirstMotor | kSecondMotor, 0};
    for (std::size_t motor = 0; motor < 2; ++motor) {
      const auto bit = static_cast<std::uint8_t>(1U << motor);
      const bool off = (bytes[code_] & bit) == 0;
      if (off || simulated::big_endian(bytes.subspan(values_ + motor * kValueSize, kValueSize)) == 0)
        command.stopped = static_cast<std::uint8_t>(command.stopped | bit);
    }
    return command;
  }

 private:
  std::size_t code_;
  std::size_t values_;
  simulated::KeyaReceiver receiver_;
};

class LawicelCommands : public HostCommands {
 public:
  std::optional<HostCommand> take(std::uint8_t byte, Time) override {
    const auto line = lines_.take(byte);
    return line ? of_line(*line) : std::nullopt;
  }

 private:
  virtual std::optional<HostCommand> of_line(std::string_view line) const = 0;
  LawicelLines lines_;
};

/// Expedited SDO downloads to node 1 (CiA 301, 7.2.4.3.3).
class CanopenCommands final : public LawicelCommands {
 public:
  explicit CanopenCommands(bool keya) : keya_(keya) {}

 private:
  std::optional<HostCommand> of_line(std::string_view line) const override {
    constexpr std::uint32_t kRequest = simulated::cob::sdo_request + 1;
    constexpr std::uint8_t kDownload = 1;
    const auto frame = simulated::lawicel_frame(line);
    if (!frame || frame->id != kRequest || frame->data[0] >> 5 != kDownload) return std::nullopt;
    const auto index = static_cast<std::uint16_t>(frame->data[1] | frame->data[2] << 8);
    const std::uint32_t value = simulated::little_endian(OctetView(frame->data).subspan(4));
    return keya_ ? keya_command(index, value) : cia402_command(index, value);
  }

  static std::optional<HostCommand> keya_command(std::uint16_t index, std::uint32_t value) {
    constexpr std::uint16_t kOrderA = 0x607A, kSpeedA = 0x6081, kOrderB = 0x6083, kSpeedB = 0x6084;
    constexpr std::uint32_t kDisable = 0x030C;  // the order's high word
    if (index != kOrderA && index != kSpeedA && index != kOrderB && index != kSpeedB) return std::nullopt;
    const std::uint8_t motor = index == kOrderA || index == kSpeedA ? kFirstMotor : kSecondMotor;
    const bool order = index == kOrderA || index == kOrderB;
    const bool stop = order ? value >> 16 == kDisable : value == 0;
    return HostCommand{motor, stop ? motor : std::uint8_t{}};
  }

  bool keya_;
};

/// "T" and an identifier of 29 bits, "8", then command, index low, index high, motor and the value, high byte first.
class KeyaCanCommands final : public LawicelCommands {
  std::optional<HostCommand> of_line(std::string_view line) const override {
    constexpr std::string_view kWrite = "T06000001823";
    constexpr std::size_t kWhole = 26;
    constexpr std::uint32_t kDisable = 0x0C, kSpeed = 0x00, kCommands = 0x20;
    if (line.size() < kWhole || !line.starts_with(kWrite)) return std::nullopt;
    const auto byte_at = [&line](std::size_t number) { return number_in(line.substr(10 + 2 * number, 2)); };
    if (byte_at(2) != kCommands) return std::nullopt;
    const std::uint8_t motor = byte_at(3) == 1U ? kFirstMotor : kSecondMotor;
    const bool stop = byte_at(1) == kDisable || (byte_at(1) == kSpeed && number_in(line.substr(18, 8)) == 0U);
    return HostCommand{motor, stop ? motor : std::uint8_t{}};
  }

  static std::uint32_t number_in(std::string_view digits) {
    constexpr int kHex = 16;
    std::uint32_t number = 0;
    static_cast<void>(std::from_chars(digits.data(), digits.data() + digits.size(), number, kHex));
    return number;
  }
};

}  // namespace

std::unique_ptr<HostCommands> make_host_commands(MotionProtocol protocol) {
  switch (protocol) {
    case MotionProtocol::kinco_serial:
      return std::make_unique<KincoCommands>();
    case MotionProtocol::id286pro_rtu:
      return std::make_unique<Id286proCommands>();
    case MotionProtocol::jd_canopen:
      return std::make_unique<CanopenCommands>(false);
    case MotionProtocol::keya_rs232:
      return std::make_unique<KeyaSerialCommands>(false);
    case MotionProtocol::keya_rs485:
      return std::make_unique<KeyaSerialCommands>(true);
    case MotionProtocol::keya_can:
      return std::make_unique<KeyaCanCommands>();
    case MotionProtocol::keya_canopen:
      break;
  }
  return std::make_unique<CanopenCommands>(true);
}

}  // namespace axisgate::bench
