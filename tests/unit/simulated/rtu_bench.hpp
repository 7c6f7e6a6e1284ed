// A simulated Modbus RTU line for tests: ask by register, let time pass, see every frame that came back.
// Promises that time only moves when a test says so, or as far as an answer takes.
// Never checks anything by itself.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/simulated/rtu_line.hpp"
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

inline nlohmann::json sheet_of(const std::string& name, const std::string& part) {
  std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
  return nlohmann::json::parse(file).at(part);
}

// The drives' motion and answers are what counts here, not the line's timing: see rtu_line_test.
inline RtuLineOptions no_line_timing() {
  RtuLineOptions options;
  options.baud = 0;
  options.reply_delay = Time{};
  return options;
}

inline KincoRtuDrive an_rtu_kinco(KincoType type, std::uint8_t station = 1) { return {a_drive(type, station), {}}; }

class RtuBench {
 public:
  explicit RtuBench(const RtuDriveOptions& drive, const RtuLineOptions& line = no_line_timing(), std::uint64_t seed = 1)
      : RtuBench(std::vector{drive}, line, seed) {}
  explicit RtuBench(const std::vector<RtuDriveOptions>& drives, const RtuLineOptions& line = no_line_timing(),
                    std::uint64_t seed = 1)
      : line_(line, Random(seed), [this](const ToHost& arrived) {
          received.insert(received.end(), arrived.bytes.begin(), arrived.bytes.end());
          arrivals.push_back({arrived.at, arrived.tag, arrived.origin, {arrived.bytes.begin(), arrived.bytes.end()}});
        }) {
    for (const RtuDriveOptions& options : drives) line_.add(options);
  }

  struct Arrival {
    Time at;
    std::uint64_t tag;
    ByteOrigin origin;
    Bytes bytes;
  };

  // What came back to these bytes at once, or after what the line takes.
  Bytes exchange(const Bytes& request) {
    received.clear();
    line_.from_host(request, now);
    return received;
  }
  // The reply's PDU; nothing when silent, or when it is no single frame of that unit.
  std::optional<Bytes> ask(const Bytes& pdu, std::uint8_t unit = 1) {
    const auto frame = open_rtu(exchange(seal_rtu(unit, pdu)));
    if (!frame || frame->unit != unit) return std::nullopt;
    return frame->pdu;
  }

  void pass(Time time) {
    now += time;
    line_.advance(now);
  }
  // Lets time pass until `done`, at most so long.
  template <class Done>
  bool pass_until(Done done, Time longest = std::chrono::seconds(60)) {
    for (const Time end = now + longest; now < end; pass(milliseconds(1))) {
      if (done()) return true;
    }
    return done();
  }

  // Registers as numbers; empty when refused or silent.
  std::vector<std::uint16_t> read(std::uint16_t start, std::uint16_t count = 1, std::uint8_t unit = 1) {
    const auto reply = ask(read_pdu(start, count), unit);
    std::vector<std::uint16_t> words;
    if (!reply || (*reply)[0] != function::read) return words;
    for (std::size_t at = 2; at + 1 < reply->size(); at += 2) words.push_back(word_at(*reply, at));
    return words;
  }
  std::uint16_t word(std::uint16_t at, std::uint8_t unit = 1) {
    const auto words = read(at, 1, unit);
    return words.size() == 1 ? words[0] : 0xDEAD;
  }
  std::int32_t pair(std::uint16_t at, std::uint8_t unit = 1) {
    const auto words = read(at, 2, unit);
    return words.size() == 2 ? static_cast<std::int32_t>(words[0] | std::uint32_t{words[1]} << 16) : 0xDEAD;
  }
  // The exception code; 0 when done, -1 when silent.
  int write(std::uint16_t at, std::int64_t value, std::uint8_t unit = 1) {
    return code_of(ask(write_pdu(at, static_cast<std::uint16_t>(value)), unit));
  }
  int write_pair(std::uint16_t at, std::int64_t value, std::uint8_t unit = 1) {
    return code_of(ask(write_long_pdu(at, value), unit));
  }
  int write_several(std::uint16_t start, const std::vector<std::uint16_t>& values, std::uint8_t unit = 1) {
    return code_of(ask(write_pdu(start, values), unit));
  }
  static int code_of(const std::optional<Bytes>& reply) {
    if (!reply) return -1;
    return ((*reply)[0] & 0x80) != 0 ? (*reply)[1] : 0;
  }

  KincoDrive& kinco(std::size_t position = 0) { return *line_.kinco(position); }
  Id286pro& id286pro(std::size_t position = 0) { return *line_.id286pro(position); }
  DriveFaults& faults(std::size_t position = 0) { return line_.faults(position); }
  RtuLine& line() { return line_; }

  Time now{};
  Bytes received;
  std::vector<Arrival> arrivals;

 private:
  RtuLine line_;
};

}  // namespace axisgate::simulated
