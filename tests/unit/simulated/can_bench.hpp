// A simulated CAN bus for tests: ask by object, let time pass, see every frame that came back.
// Promises that time only moves when a test says so, or as far as an answer takes.
// Never checks anything by itself.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/simulated/can_line.hpp"
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

inline nlohmann::json can_sheet(const std::string& name, const std::string& part) {
  std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
  return nlohmann::json::parse(file).at(part);
}

// The drives' motion and answers are what counts here, not the bus's timing: see can_line_test.
inline CanLineOptions no_can_timing() {
  CanLineOptions options;
  options.bit_rate = 0;
  options.reply_delay = Time{};
  return options;
}

inline KincoCanDrive a_can_kinco(KincoType type, std::uint8_t node = 1) { return {a_drive(type, node), {}}; }
inline LeadshineOptions a_leadshine(std::uint8_t node = 1) {
  LeadshineOptions options;
  options.node = node;
  return options;
}

class CanBench {
 public:
  explicit CanBench(const CanDriveOptions& drive, const CanLineOptions& line = no_can_timing(), std::uint64_t seed = 1)
      : CanBench(std::vector{drive}, line, seed) {}
  explicit CanBench(const std::vector<CanDriveOptions>& drives, const CanLineOptions& line = no_can_timing(),
                    std::uint64_t seed = 1)
      : line_(line, Random(seed), [this](const CanToHost& frame) { received.push_back(frame); }) {
    for (const CanDriveOptions& options : drives) line_.add(options);
  }

  void send(const BusFrame& frame) { line_.from_host(frame, now); }
  void nmt(std::uint8_t command, std::uint8_t node = 1) { send(bus_frame(cob::nmt, {command, node})); }
  // What came back to this frame at once, its identifier aside.
  std::vector<Bytes> exchange(const BusFrame& frame) {
    received.clear();
    send(frame);
    std::vector<Bytes> replies;
    for (const CanToHost& reply : received) replies.push_back(data_of(reply));
    return replies;
  }
  static Bytes data_of(const CanToHost& frame) {
    const CanView bytes = bytes_of(frame.frame);
    return {bytes.begin(), bytes.end()};
  }
  // The SDO reply to these eight bytes; nothing when silent.
  std::optional<Bytes> sdo(const Bytes& request, std::uint8_t node = 1) {
    received.clear();
    send(bus_frame(cob::sdo_request + node, request));
    for (const CanToHost& reply : received) {
      if (reply.frame.id == cob::sdo_reply + node) return data_of(reply);
    }
    return std::nullopt;
  }

  void pass(Time time) {
    now += time;
    line_.advance(now);
  }
  template <class Done>
  bool pass_until(Done done, Time longest = std::chrono::seconds(60)) {
    for (const Time end = now + longest; now < end; pass(milliseconds(1))) {
      if (done()) return true;
    }
    return done();
  }

  // A number of at most four bytes; nothing when refused or silent.
  std::optional<std::uint32_t> read(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t node = 1) {
    const auto reply = sdo(request(0x40, index, sub, 0), node);
    if (!reply || ((*reply)[0] & 0xE3) != 0x43) return std::nullopt;
    const auto size = static_cast<std::size_t>(4 - ((*reply)[0] >> 2 & 3));
    return little_endian(CanView(*reply).subspan(4, size));
  }
  std::int32_t number(std::uint16_t index, std::uint8_t sub = 0) {
    return static_cast<std::int32_t>(read(index, sub).value_or(0xDEADDEAD));
  }
  std::uint16_t status() { return static_cast<std::uint16_t>(read(0x6041).value_or(0)); }
  // The abort code; 0 when done, nothing when silent. The width is the object's.
  std::optional<std::uint32_t> write(std::uint16_t index, std::uint8_t sub, std::int64_t value, std::uint8_t node = 1) {
    const auto present = line_.node(position_of(node)).peek({index, sub}, now);
    return write_wide(index, sub, value, present ? present->size() : 4, node);
  }
  std::optional<std::uint32_t> write_wide(std::uint16_t index, std::uint8_t sub, std::int64_t value, std::size_t width,
                                          std::uint8_t node = 1) {
    const auto command = static_cast<std::uint8_t>(0x23 | (4 - width) << 2);
    return code_of(sdo(request(command, index, sub, static_cast<std::uint32_t>(value)), node));
  }
  static std::optional<std::uint32_t> code_of(const std::optional<Bytes>& reply) {
    if (!reply) return std::nullopt;
    return (*reply)[0] == 0x80 ? little_endian(CanView(*reply).subspan(4)) : 0;
  }
  static Bytes request(std::uint8_t command, std::uint16_t index, std::uint8_t sub, std::uint32_t data) {
    Bytes bytes{command, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub};
    const CanBytes four = little_endian(data, 4);
    bytes.insert(bytes.end(), four.begin(), four.end());
    return bytes;
  }
  void control(std::uint16_t word) { (void)write(0x6040, 0, word); }
  void enable() {
    for (const std::uint16_t word : {std::uint16_t{0x06}, std::uint16_t{0x07}, std::uint16_t{0x0F}}) control(word);
  }
  // Frames of this identifier since the last exchange.
  std::vector<Bytes> heard(std::uint32_t id) const {
    std::vector<Bytes> found;
    for (const CanToHost& frame : received) {
      if (frame.frame.id == id) found.push_back(data_of(frame));
    }
    return found;
  }

  CanopenNode& node(std::size_t position = 0) { return line_.node(position); }
  KincoDrive& kinco(std::size_t position = 0) { return *line_.kinco(position); }
  LeadshineDrive& leadshine(std::size_t position = 0) { return *line_.leadshine(position); }
  DriveFaults& faults(std::size_t position = 0) { return line_.faults(position); }
  CanLine& line() { return line_; }

  Time now{};
  std::vector<CanToHost> received;

 private:
  std::size_t position_of(std::uint8_t number) {
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (line_.node(i).node() == number) return i;
    }
    return 0;
  }

  CanLine line_;
};

}  // namespace axisgate::simulated
