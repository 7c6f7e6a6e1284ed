// A simulated line for tests: ask by object, let time pass, see every byte that came back.
// Promises that time only moves when a test says so.
// Never checks anything by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulated/serial_line.hpp"

namespace axisgate::simulated {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
    i += 2;
  }
  return bytes;
}

inline DriveOptions a_drive(KincoType type, std::uint8_t station = 1) {
  DriveOptions options;
  options.type = type;
  options.station = station;
  return options;
}

class Bench {
 public:
  explicit Bench(const DriveOptions& drive, const LineOptions& line = {}, std::uint64_t seed = 1)
      : Bench(std::vector{drive}, line, seed) {}
  explicit Bench(const std::vector<DriveOptions>& drives, const LineOptions& line = {}, std::uint64_t seed = 1)
      : line_(line, Random(seed), [this](const ToHost& arrived) {
          received.insert(received.end(), arrived.bytes.begin(), arrived.bytes.end());
          arrivals.push_back({arrived.at, arrived.tag, arrived.origin, arrived.bytes.size()});
        }) {
    for (const DriveOptions& options : drives) line_.add(options);
  }

  struct Arrival {
    Time at;
    std::uint64_t tag;
    ByteOrigin origin;
    std::size_t length;
  };

  // What came back to these bytes at once.
  Bytes exchange(const Bytes& request) {
    received.clear();
    line_.from_host(request, now);
    return received;
  }
  Bytes exchange(const TenByteFrame& request) { return exchange(Bytes(request.begin(), request.end())); }

  void pass(Time time) {
    now += time;
    line_.advance(now);
  }

  // Lets time pass until the bits are set in the statusword, at most so long.
  bool wait_for(std::uint16_t bits, Time longest = std::chrono::seconds(60)) {
    for (const Time end = now + longest; now < end; pass(milliseconds(1))) {
      if ((status() & bits) == bits) return true;
    }
    return false;
  }

  // The reply's command and data.
  struct Answer {
    FrameCommand command;
    std::uint32_t data;
  };
  std::optional<Answer> ask(FrameCommand command, std::uint16_t index, std::uint8_t sub, std::uint32_t data,
                            std::uint8_t station = 1) {
    const Bytes reply = exchange(seal(station, command, index, sub, data));
    if (reply.size() < frame_length) return std::nullopt;
    TenByteFrame frame{};
    std::copy(reply.end() - frame_length, reply.end(), frame.begin());
    return Answer{command_of(frame), data_of(frame)};
  }
  std::int64_t read(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t station = 1) {
    const auto answer = ask(FrameCommand::read, index, sub, 0, station);
    if (!answer) return -1;
    return value_in(type_of(index, sub), answer->data);
  }
  // The code of a refusal, 0 when done, nothing when silent.
  std::optional<std::uint32_t> write(std::uint16_t index, std::uint8_t sub, std::int64_t value,
                                     std::uint8_t station = 1) {
    const int width = bytes_of(type_of(index, sub));
    const FrameCommand command = width == 4   ? FrameCommand::write_4
                                 : width == 2 ? FrameCommand::write_2
                                              : FrameCommand::write_1;
    const auto answer = ask(command, index, sub, static_cast<std::uint32_t>(value), station);
    if (!answer) return std::nullopt;
    return answer->command == FrameCommand::error ? answer->data : 0;
  }
  std::uint16_t status() { return static_cast<std::uint16_t>(read(0x6041)); }
  void control(std::uint16_t word) { write(0x6040, 0, word); }

  KincoDrive& drive(std::size_t position = 0) { return line_.drive(position); }
  DriveFaults& faults(std::size_t position = 0) { return line_.faults(position); }
  SerialLine& line() { return line_; }

  Time now{};
  Bytes received;
  std::vector<Arrival> arrivals;

 private:
  ObjectType type_of(std::uint16_t index, std::uint8_t sub) {
    for (const auto table : {drive().model().motion_objects, drive().model().setup_objects}) {
      for (const ObjectEntry& entry : table) {
        if (entry.key() == ObjectKey{index, sub}) return entry.type;
      }
    }
    return ObjectType::u32;
  }

  SerialLine line_;
};

}  // namespace axisgate::simulated
