// SPDX-License-Identifier: Apache-2.0
// A test's desk: an image with axes 1, 2 and 5, a fake command port and clients with connections, all in one thread.
// Promises that a dialogue reads as a transcript: plc.ask("03 00 64 00 02") gives "03 04 00 00 00 00".
// Never advances time by itself.
#pragma once

#include <gtest/gtest.h>

#include <iomanip>
#include <memory>
#include <sstream>
#include <string>

#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/unit/modbus_tcp/support/fake_command_port.hpp"
#include "tests/unit/modbus_tcp/support/hex.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::modbus_tcp::test {

using namespace std::chrono_literals;

inline const Address kPlc{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, 7};
inline const Address kPanel{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, 8};

class Desk {
 public:
  Desk() {
    for (const AxisNumber n : {AxisNumber{1}, AxisNumber{2}, AxisNumber{5}}) {
      AxisImage& axis = image.add_axis(n, "axis " + std::to_string(n), 0);
      axis.supported = ~0U;
      axis.writable = ~((1U << 14) - 1);
      axis.supported_commands = 0x7FFE;
      axis.link_state = LinkState::online;
      for (const QuantityRow& each : quantity_table()) {
        axis[each.quantity] = {0, true, true, runtime.now()};
        axis.limits[static_cast<std::size_t>(each.quantity)] = range_of(each.type);
      }
      axis.oldest_cyclic = runtime.now();
    }
    image.buses.resize(2);
  }

  AxisImage& axis(AxisNumber n) { return *image.find(n); }
  /// What the port was given since the last time, a write batch between commas: "target_torque=7 mode=1, axis 5: enable
  /// id=2", "target_position=7+" where it asks only beside the command, "nothing" for a write batch that asks for
  /// nothing,
  /// "-" for no write batch at all.
  std::string asked() {
    std::string out;
    for (const auto& [number, batch] : port.taken())
      out += (out.empty() ? "" : ", ") + (number == 1 ? "" : "axis " + std::to_string(number) + ": ") + told(batch);
    return out.empty() ? "-" : out;
  }
  /// What was logged since the last time, lines between " | "; "-" for nothing.
  std::string logged() {
    std::string out;
    for (const std::string& line : std::exchange(lines_, {})) out += (out.empty() ? "" : " | ") + line;
    return out.empty() ? "-" : out;
  }
  SessionContext context() { return {settings, image, port, registry, log, &runtime}; }

  static std::string told(const WriteBatch& batch) {
    std::string out;
    const auto add = [&out](const auto&... parts) {
      std::ostringstream text;
      ((text << (out.empty() ? "" : " ")) << ... << parts);
      out += text.str();
    };
    for (const Setpoint& each : batch.setpoints)
      add(quantity_table()[static_cast<std::size_t>(each.quantity)].name, '=', each.value,
          each.with_command ? "+" : "");
    if (batch.mode) add("mode=", *batch.mode);
    if (batch.controlword) {
      add("controlword=", std::uppercase, std::hex, *batch.controlword, batch.single_controlword ? " alone" : "");
    }
    if (batch.set_position_value) add("set_position_value=", *batch.set_position_value);
    if (batch.jog_velocity) add("jog_velocity=", *batch.jog_velocity);
    if (batch.command != Command::none) add(text(batch.command));
    if (batch.command != Command::none && batch.command_id != 0) add("id=", batch.command_id);
    if (batch.jog_again) add("again ", text(*batch.jog_again));
    if (batch.object) add(told(*batch.object));
    return out.empty() && asks_nothing(batch) ? "nothing" : out;
  }
  /// "reads 6064.00", "reads 6064.00/4", "writes 6040.00/2=F", "writes 2000.07: 01 02 03".
  static std::string told(const ObjectRequest& object) {
    std::ostringstream out;
    out << (object.write ? "writes " : "reads ") << std::uppercase << std::hex << std::setfill('0') << std::setw(4)
        << object.index << '.' << std::setw(2) << int{object.subindex};
    if (object.size != 0) out << '/' << int{object.size};
    if (object.count != 0) out << " of " << object.count;
    if (object.write && object.bytes) out << ": " << hex_text(*object.bytes);
    if (object.write && !object.bytes) out << '=' << object.data;
    return out.str();
  }

  axisgate::test::ManualRuntime runtime;
  ListenerSettings settings;
  Duration waited{};  ///< in its socket, what is read now
  ProcessImage image;
  FakeCommandPort port;
  ClientRegistry registry;
  Log log{[this](LogLevel, std::string_view, std::string_view line) { lines_.emplace_back(line); }};

 private:
  std::vector<std::string> lines_;
};

/// One connection to the desk.
class Line {
 public:
  explicit Line(Desk& desk, Role role = Role::engineer, const Address& from = kPlc)
      : Line(desk, Peer{from, 50000, role, 0}) {}
  Line(Desk& desk, const Peer& peer)
      : desk_(desk), session_(desk.context(), peer, desk.runtime.now(), [this] { ++told; }) {}

  /// Sends a request; gives what came back by now: the reply's PDU, "" where none did yet, "closed".
  std::string ask(const std::string& pdu, std::uint8_t unit = 1) {
    send(pdu, unit);
    return reply();
  }
  void send(const std::string& pdu, std::uint8_t unit = 1) {
    const Instant now = desk_.runtime.now();
    session_.on_bytes(frame(++transaction_, unit, bytes(pdu)), now, now - desk_.waited);
  }
  void feed(const std::vector<Byte>& raw) { session_.on_bytes(raw, desk_.runtime.now()); }
  /// The next reply's PDU, taken off the output; its header is checked against the request's place in line.
  std::string reply() {
    const Bytes output = session_.output();
    if (output.empty()) return session_.finished() ? "closed" : "";
    EXPECT_GE(output.size(), 9U);
    EXPECT_EQ(load_be16(output, 0), ++answered_) << "replies come in request order";
    EXPECT_EQ(load_be16(output, 2), 0);
    const std::size_t size = load_be16(output, 4) - 1U;
    const std::string pdu = hex_text(output.subspan(7, size));
    session_.take_output(7 + size, desk_.runtime.now());
    return pdu;
  }
  /// A register as this client reads it.
  std::string read(std::uint16_t address, std::uint16_t count = 1, std::uint8_t unit = 1) {
    const std::string answer = ask("03" + word(address) + word(count), unit);
    return answer.size() > 6 ? answer.substr(6) : answer;
  }
  std::string write(std::uint16_t address, std::int64_t value) { return ask("06" + word(address) + word(value)); }
  std::string write_coil(std::uint16_t address, bool on) { return ask("05" + word(address) + (on ? "FF00" : "0000")); }
  /// FC 16; `registers` in hex.
  std::string write_block(std::uint16_t address, const std::string& registers) {
    const std::size_t count = bytes(registers).size() / 2;
    return ask(block_write(address, registers, count));
  }
  static std::string block_write(std::uint16_t address, const std::string& registers, std::size_t count) {
    const Byte size[] = {static_cast<Byte>(2 * count)};
    return "10" + word(address) + word(static_cast<std::int64_t>(count)) + hex_text(size) + registers;
  }
  Session& session() { return session_; }
  /// The client that speaks here, as its last write batch named it.
  std::shared_ptr<const ClientLife> life() {
    static_cast<void>(ask("06 00 B6 00 00"));  // a row of the mailbox: claims and starts nothing
    return desk_.port.submitted.back().batch.life;
  }

  int told = 0;

 private:
  Desk& desk_;
  std::uint16_t transaction_ = 0;
  std::uint16_t answered_ = 0;
  Session session_;
};

/// The reply to a write that was carried out: FC 5 and 6 echo it, 16 repeats address and count.
inline bool is_exception(const std::string& reply, int code) {
  return reply.size() == 5 && bytes(reply)[0] >= 0x80 && bytes(reply)[1] == code;
}
inline bool is_done(const std::string& reply) { return reply.size() > 5 && bytes(reply)[0] < 0x80; }

/// The commands that the port was given, and forgotten by it.
inline std::vector<Command> commands(Desk& desk) {
  std::vector<Command> out;
  for (const auto& each : desk.port.taken())
    if (each.batch.command != Command::none) out.push_back(each.batch.command);
  return out;
}

/// A desk with one engineer's connection.
class AtTheDesk : public ::testing::Test {
 protected:
  const WriteBatch& last() { return desk.port.submitted.back().batch; }
  Desk desk;
  Line plc{desk};
};

}  // namespace axisgate::modbus_tcp::test
