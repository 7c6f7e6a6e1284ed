// Simulated lines for tests: send, let time pass, see everything that came back.
// Promises that time only moves when a test says so, or as far as an answer takes.
// Never checks anything by itself.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/simulated/can_line.hpp"
#include "tests/simulated/keya_line.hpp"
#include "tests/simulated/rtu_line.hpp"
#include "tests/simulated/serial_line.hpp"
#include "tests/unit/simulated/scene.hpp"

namespace axisgate::simulated {

using std::chrono::microseconds;
using std::chrono::seconds;

// A part of what was copied from a maker's manual.
inline nlohmann::json sheet_of(const std::string& name, const std::string& part) {
  std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
  return nlohmann::json::parse(file).at(part);
}

// Every vector of a sheet for this protocol and direction.
template <class Visit>
void each_vector(const std::string& sheet, const std::string& protocol, const std::string& direction, Visit visit) {
  const auto vectors = sheet_of(sheet, "vectors");
  for (const auto& vector : vectors) {
    if (vector.at("protocol") != protocol || vector.at("direction") != direction) continue;
    if (!vector.value("well_formed", true)) continue;
    SCOPED_TRACE(vector.at("id").template get<std::string>());
    visit(vector);
  }
}

inline std::uint32_t hex_number(const nlohmann::json& text) {
  return static_cast<std::uint32_t>(std::stoul(text.get<std::string>(), nullptr, 16));
}

inline ObjectKey key_in(const nlohmann::json& row) {
  return {static_cast<std::uint16_t>(hex_number(row.at("index"))),
          row.at("sub").is_null() ? std::uint8_t{0} : row.at("sub").get<std::uint8_t>()};
}

inline DriveOptions a_drive(KincoType type, std::uint8_t station = 1) {
  DriveOptions options;
  options.type = type;
  options.station = station;
  return options;
}

inline KincoRtuDrive an_rtu_kinco(KincoType type, std::uint8_t unit = 1) { return {a_drive(type, unit), {}}; }
inline KincoCanDrive a_can_kinco(KincoType type, std::uint8_t node = 1) { return {a_drive(type, node), {}}; }

inline LeadshineOptions a_leadshine(std::uint8_t node = 1) {
  LeadshineOptions options;
  options.node = node;
  return options;
}

inline KeyaOptions a_keya(std::map<int, std::int64_t> parameters = {}, std::uint8_t node = 1) {
  KeyaOptions options;
  options.node = node;
  options.parameters = std::move(parameters);
  options.heartbeat = Time{};
  return options;
}

// Its two motors in this mode.
inline KeyaOptions in_mode(std::int64_t mode) { return a_keya({{20, mode}, {50, mode}}); }

inline constexpr KeyaMotorName motor_a = KeyaMotorName::a, motor_b = KeyaMotorName::b;

// What counts in most tests is what the drives do, not the line's timing.
inline RtuLineOptions no_line_timing() {
  RtuLineOptions options;
  options.baud = 0;
  options.reply_delay = Time{};
  return options;
}

inline CanLineOptions no_can_timing() {
  CanLineOptions options;
  options.bit_rate = 0;
  options.reply_delay = Time{};
  return options;
}

// A line of bytes, of whatever protocol.
template <class Line>
class ByteBench {
 public:
  template <class Drive, class Options>
  ByteBench(const std::vector<Drive>& drives, const Options& options, std::uint64_t seed = 1)
      : line(options, Random(seed), [this](const ToHost& arrived) {
          received.insert(received.end(), arrived.bytes.begin(), arrived.bytes.end());
          arrivals.push_back({arrived.at, arrived.tag, arrived.origin, {arrived.bytes.begin(), arrived.bytes.end()}});
        }) {
    for (const Drive& drive : drives) line.add(drive);
  }

  // What came back to these bytes at once, or after what the line takes.
  Bytes exchange(const Bytes& request) {
    received.clear();
    line.from_host(request, now);
    return received;
  }
  void pass(Time time) {
    now += time;
    line.advance(now);
  }
  template <class Done>
  bool pass_until(Done done, Time longest = seconds(60)) {
    for (const Time end = now + longest; now < end; pass(milliseconds(1))) {
      if (done()) return true;
    }
    return done();
  }

  struct Arrival {
    Time at;
    std::uint64_t tag;
    ByteOrigin origin;
    Bytes bytes;
  };
  Time now{};
  Bytes received;
  std::vector<Arrival> arrivals;
  Line line;
};

class KincoBench : public ByteBench<SerialLine> {
 public:
  explicit KincoBench(const std::vector<DriveOptions>& drives, const LineOptions& options = {}, std::uint64_t seed = 1)
      : ByteBench(drives, options, seed) {}
};

class RtuBench : public ByteBench<RtuLine> {
 public:
  explicit RtuBench(const std::vector<RtuDriveOptions>& drives, const RtuLineOptions& options = no_line_timing(),
                    std::uint64_t seed = 1)
      : ByteBench(drives, options, seed) {}
};

class KeyaBench : public ByteBench<KeyaLine> {
 public:
  KeyaBench(KeyaWiring wiring, const std::vector<KeyaOptions>& drives, std::uint32_t baud = 0)
      : ByteBench(drives, KeyaLineOptions{wiring, baud, Time{}, 1000}) {}
};

class CanBench {
 public:
  explicit CanBench(const std::vector<CanDriveOptions>& drives, const CanLineOptions& options = no_can_timing(),
                    std::uint64_t seed = 1)
      : line(options, Random(seed), [this](const CanToHost& frame) { received.push_back(frame); }) {
    for (const CanDriveOptions& drive : drives) line.add(drive);
  }

  void send(const BusFrame& frame) { line.from_host(frame, now); }
  void pass(Time time) {
    now += time;
    line.advance(now);
  }
  // The SDO reply to these bytes, or nothing.
  Bytes sdo(const Bytes& request, std::uint8_t node = 1) {
    received.clear();
    send(bus_frame(cob::sdo_request + node, request));
    return heard(cob::sdo_reply + node);
  }
  // The newest frame of this identifier since the last request; empty: there is none.
  Bytes heard(std::uint32_t id) const {
    for (auto frame = received.rbegin(); frame != received.rend(); ++frame) {
      if (frame->frame.id == id) return {frame->frame.data.begin(), frame->frame.data.begin() + frame->frame.size};
    }
    return {};
  }

  Time now{};
  std::vector<CanToHost> received;
  CanLine line;
};

inline Bytes sdo_request(std::uint8_t command, ObjectKey key, std::uint32_t data = 0) {
  Bytes bytes{command, static_cast<std::uint8_t>(key.index), static_cast<std::uint8_t>(key.index >> 8), key.sub};
  const CanBytes four = little_endian(data, 4);
  bytes.insert(bytes.end(), four.begin(), four.end());
  return bytes;
}

// Its command byte for so many bytes.
inline std::uint8_t sdo_write(std::size_t width) { return static_cast<std::uint8_t>(0x23 | (4 - width) << 2); }

inline Bytes ten_bytes(FrameCommand command, ObjectKey key, std::uint32_t data = 0, std::uint8_t station = 1) {
  const TenByteFrame frame = seal(station, command, key.index, key.sub, data);
  return {frame.begin(), frame.end()};
}

}  // namespace axisgate::simulated
