// Simulated Keya drives for tests, on each of their interfaces: frames in hex, time by hand.
// Promises that time only moves when a test says so.
// Never checks anything by itself.
#pragma once

#include "tests/simulated/keya_line.hpp"
#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {

inline nlohmann::json keya_vectors(const std::string& protocol, const std::string& direction) {
  nlohmann::json found = nlohmann::json::array();
  const auto rows = can_sheet("keya-kydas4860-2e", "vectors");
  for (const auto& vector : rows) {
    if (vector.at("protocol") == protocol && vector.at("direction") == direction) found.push_back(vector);
  }
  return found;
}

inline Bytes bytes_of_vector(const nlohmann::json& vector) {
  return from_hex(vector.value("hex_corrected", vector.at("hex").get<std::string>()));
}

inline KeyaOptions a_keya(std::map<int, std::int64_t> parameters = {}, std::uint8_t node = 1) {
  KeyaOptions options;
  options.node = node;
  options.parameters = std::move(parameters);
  options.heartbeat = Time{};
  return options;
}

inline constexpr KeyaMotorName motor_a = KeyaMotorName::a, motor_b = KeyaMotorName::b;

class KeyaBench {
 public:
  explicit KeyaBench(KeyaWiring wiring, const std::vector<KeyaOptions>& drives, std::uint32_t baud = 0)
      : line_({wiring, baud, Time{}, 1000}, Random(1), [this](const ToHost& chunk) {
          arrivals.push_back({chunk.at, chunk.tag, {chunk.bytes.begin(), chunk.bytes.end()}});
        }) {
    for (const KeyaOptions& options : drives) line_.add(options);
  }

  Bytes exchange(const Bytes& frame) {
    arrivals.clear();
    line_.from_host(frame, now);
    return received();
  }
  Bytes exchange(std::string_view hex) { return exchange(from_hex(hex)); }
  Bytes received() const {
    Bytes all;
    for (const Arrival& arrival : arrivals) all.insert(all.end(), arrival.bytes.begin(), arrival.bytes.end());
    return all;
  }
  void pass(Time time) {
    now += time;
    line_.advance(now);
  }
  // A control frame on RS485, checksum and all.
  void control_at(std::uint8_t node, std::uint8_t code, std::int32_t a = 0, std::int32_t b = 0) {
    KeyaFrame frame{keya_start::control, node, code};
    put_big_endian(std::span(frame).subspan(3, 4), a);
    put_big_endian(std::span(frame).subspan(7, 4), b);
    frame = seal_keya(frame);
    line_.from_host(frame, now);
  }
  // The same on RS232.
  void control(std::uint8_t code, std::int32_t a = 0, std::int32_t b = 0) {
    KeyaFrame frame{keya_start::control, code};
    put_big_endian(std::span(frame).subspan(4, 4), a);
    put_big_endian(std::span(frame).subspan(8, 4), b);
    line_.from_host(frame, now);
  }

  KeyaDrive& drive(std::size_t position = 0) { return line_.drive(position); }
  KeyaLine& line() { return line_; }

  struct Arrival {
    Time at;
    std::uint64_t tag;
    Bytes bytes;
  };
  Time now{};
  std::vector<Arrival> arrivals;

 private:
  KeyaLine line_;
};

// Keya's CAN protocol: eight bytes out, the reply's eight bytes back; nothing: silence.
class KeyaCanBench : public CanBench {
 public:
  explicit KeyaCanBench(const KeyaOptions& options) : CanBench(KeyaCanDrive{options}), node_(options.node) {}

  std::optional<Bytes> ask(const Bytes& request, std::optional<std::uint32_t> id = std::nullopt) {
    received.clear();
    BusFrame frame = bus_frame(id.value_or(keya_can::command + node_), request);
    frame.extended = true;
    send(frame);
    for (const CanToHost& reply : received) {
      if (reply.frame.extended && reply.frame.id == keya_can::reply + node_) return data_of(reply);
    }
    return std::nullopt;
  }
  std::optional<Bytes> ask(std::string_view hex) { return ask(from_hex(hex)); }
  bool write(std::uint16_t index, std::uint8_t sub, std::int32_t value = 0) {
    Bytes bytes{0x23, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub, 0, 0, 0, 0};
    put_big_endian(std::span(bytes).last(4), value);
    return ask(bytes).has_value();
  }
  KeyaDrive& drive() { return *line().keya(0); }

 private:
  std::uint8_t node_;
};

}  // namespace axisgate::simulated
