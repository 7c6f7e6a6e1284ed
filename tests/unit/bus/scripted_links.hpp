// SPDX-License-Identifier: Apache-2.0
// Links whose far end is the test: of bytes, of CAN frames, of Modbus RTU frames.
#pragma once

#include <string>
#include <vector>

#include "adapters/bus/byte_link.hpp"
#include "adapters/can/can_link.hpp"
#include "adapters/modbus_rtu/rtu_link.hpp"
#include "tests/unit/bus/wire_stage.hpp"

namespace axisgate::test {

class ScriptedLink final : public bus::ByteLink {
 public:
  void start(bus::ByteLinkEvents& to) override { events = &to; }
  void send(Bytes bytes) override { sent.push_back(hex_text(bytes)); }
  void reopen(std::string_view why) override {
    reopened.emplace_back(why);
    events->on_link_down(why);
    events->on_link_up();
  }
  void bring(Bytes bytes) { events->on_bytes(bytes); }
  void bring(std::string_view hex) { bring(from_hex(hex)); }

  bus::ByteLinkEvents* events = nullptr;
  std::vector<std::string> sent, reopened;
};

class ScriptedCanLink final : public can::CanLink {
 public:
  void start(can::CanLinkEvents& to, std::vector<can::CanFilter> only) override {
    events = &to;
    filters = std::move(only);
  }
  void send(const can::CanFrame& frame, bool urgent) override {
    sent.push_back(frame);
    if (urgent) urgent_sent.push_back(frame);
  }
  [[nodiscard]] const can::CanTrouble& trouble() const override { return troubles; }

  can::CanLinkEvents* events = nullptr;
  std::vector<can::CanFilter> filters;
  std::vector<can::CanFrame> sent, urgent_sent;
  can::CanTrouble troubles;
};

class ScriptedRtuLink final : public modbus_rtu::RtuLink {
 public:
  void start(modbus_rtu::RtuLinkEvents& to) override { events = &to; }
  void transmit(modbus_rtu::ExchangeNumber number, Bytes frame) override {
    newest = number;
    sent.push_back(hex_text(frame));
  }
  void withdraw(modbus_rtu::ExchangeNumber number) override { withdrawn.push_back(number); }
  void reopen(std::string_view why) override {
    reopened.emplace_back(why);
    events->on_link_down(why);
    if (opens_again) events->on_link_up();
  }
  /// Heard after the newest frame was sent.
  void bring(std::string_view frame) { bring(newest, frame); }
  void bring(modbus_rtu::ExchangeNumber number, std::string_view frame) { events->on_frame(number, from_hex(frame)); }

  modbus_rtu::RtuLinkEvents* events = nullptr;
  modbus_rtu::ExchangeNumber newest = 0;
  std::vector<std::string> sent, reopened;
  std::vector<modbus_rtu::ExchangeNumber> withdrawn;
  bool opens_again = true;
};

}  // namespace axisgate::test
