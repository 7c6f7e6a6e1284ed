// SPDX-License-Identifier: Apache-2.0
// A client of the long day: one connection to the shipped Modbus session, for a few axes that it reads, enables, runs
// and stops, again and again. Promises at most one request under way, and that each is counted as answered, refused or
// lost with its connection. Never waits: it looks for its answer when it is called.
#pragma once

#include <memory>
#include <vector>

#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/simulated/random.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test::long_day {

struct Asked {
  std::uint64_t requests = 0, answers = 0, exceptions = 0, lost = 0;
};

class DayClient {
 public:
  DayClient(const modbus_tcp::SessionContext& context, ManualRuntime& runtime, std::uint8_t host,
            std::vector<AxisNumber> axes, std::uint64_t seed);
  ~DayClient() { leave(); }
  DayClient(const DayClient&) = delete;
  DayClient& operator=(const DayClient&) = delete;

  /// Its next request, if the one before it was answered.
  void turn();
  /// The connection ends, with whatever is under way; the next turn makes another one.
  void leave();
  [[nodiscard]] const Asked& asked() const { return asked_; }
  [[nodiscard]] bool waits() const { return asked_.requests > asked_.answers + asked_.lost; }
  /// Something went against the promise of one answer for each request; empty: nothing.
  [[nodiscard]] const std::string& wrong() const { return wrong_; }

 private:
  void connect();
  void send(const std::vector<Byte>& pdu);
  void receive();
  [[nodiscard]] std::vector<Byte> next_pdu();

  const modbus_tcp::SessionContext context_;
  ManualRuntime& runtime_;
  modbus_tcp::Peer peer_;
  const std::vector<AxisNumber> axes_;
  simulated::Random random_;
  std::unique_ptr<Timer> deadline_;
  std::unique_ptr<modbus_tcp::Session> session_;
  std::vector<Byte> incoming_;
  std::uint16_t transaction_ = 0;
  Asked asked_;
  std::string wrong_;
};

}  // namespace axisgate::test::long_day
