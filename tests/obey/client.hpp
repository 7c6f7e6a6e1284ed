// SPDX-License-Identifier: Apache-2.0
// A Modbus-TCP client of these tests: one connection from one address to the shipped session, bytes in memory, manual
// time. Promises to return when the answer is there, or to tell it later; a request whose connection or gateway died
// has none for ever. Never looks into the gateway.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/model/write.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test::obey {

using namespace reference;  // what a client writes

struct Answer {
  std::uint8_t exception = 0;          ///< 0: none
  std::vector<std::uint16_t> words{};  ///< of 43/13 the object's bytes
  [[nodiscard]] bool ok() const { return exception == 0; }
  friend bool operator==(const Answer& answer, std::uint8_t exception) { return answer.exception == exception; }
};
void PrintTo(const Answer& answer, std::ostream* out);

inline constexpr std::int64_t kNoState = 9;  // result: the axis's state does not allow it
inline constexpr std::uint8_t kOk = 0, kNoSuchRow = 2, kBadValue = 3, kFailed = 4, kNotNow = 6;

/// Offsets to read.
namespace shown {
inline constexpr std::uint16_t statusword = 0, position = 2, supported = 20, result = 25, detail = 26, owner = 28,
                               lease_remaining = 29, id_seen = 30, axis_state = 31, motion_state = 32, motion_id = 33,
                               supported_commands = 36, supported_modes = 38, count = 39;
}  // namespace shown
inline constexpr std::int64_t kNotOwner = 7, kNotNew = 10, kNobody = 0, kMe = 1, kAnother = 2;
inline constexpr std::int64_t kStandstill = 1, kStopLatched = 5;  ///< axis_state

class Client;

/// Where the gateway listens. While none runs nobody answers there.
class ServedPort {
 public:
  void open(const modbus_tcp::SessionContext& context) { context_.emplace(context); }
  /// Whoever served is dead: all connections are gone, and nobody was told.
  void close();
  /// Who is told of each request and answer.
  std::function<void(bool to_gateway, Bytes adu)> on_modbus = [](bool, Bytes) {};

 private:
  friend class Client;
  std::optional<modbus_tcp::SessionContext> context_;
  std::vector<Client*> clients_;
};

using RequestNumber = std::uint64_t;

class Client {
 public:
  /// `host`: the last byte of its address. `listener`: of its own, instead of the port's.
  Client(ServedPort& port, ManualRuntime& runtime, std::uint8_t host,
         std::optional<modbus_tcp::ListenerSettings> listener = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Returns when the answer is there; throws where there is none.
  Answer write(const Write& write);
  /// Sends and returns at once.
  RequestNumber begin(const Write& write);
  /// None yet, or never.
  [[nodiscard]] std::optional<Answer> answer_of(RequestNumber number) const;
  Answer row(std::uint16_t offset, std::int64_t value) { return write(one(offset, value)); }
  Answer rows(std::uint16_t first, std::uint16_t last, const Rows& values) { return write(block(first, last, values)); }
  Answer command(std::int64_t number) { return row(row::command, number); }
  /// 54 and 55 in one request.
  Answer command(std::int64_t number, std::int64_t id) {
    return rows(row::command, row::command_id, {{row::command, number}, {row::command_id, id}});
  }
  Answer coil(std::uint16_t number, bool on) { return write(one_coil(number, on)); }
  /// Registers of the axis, function 3.
  std::vector<std::uint16_t> read(std::uint16_t first, std::uint16_t count);
  /// The same; an exception is an answer too.
  Answer answer_to_read(std::uint16_t first, std::uint16_t count) { return awaited(begin_read(first, count)); }
  std::uint16_t word(std::uint16_t offset) { return read(offset, 1).front(); }
  std::int32_t wide(std::uint16_t offset);
  std::int64_t result() { return word(shown::result); }
  /// Any object of the drive, by registers 80 to 86; when it is done. False: it failed.
  bool mailbox_write(std::uint16_t index, std::uint16_t subindex, std::uint16_t size, std::int64_t data);

  /// The same. Returns at once.
  RequestNumber begin_read(std::uint16_t first, std::uint16_t count);
  /// By 43/13, the whole of any object. Returns at once.
  RequestNumber ask_for_object(std::uint16_t index, std::uint8_t subindex);

  /// Any bytes, which may be no request. From then on what comes back on this connection is told by replies() alone.
  void say(const std::vector<std::uint8_t>& bytes);
  [[nodiscard]] std::size_t replies() const;

  /// As `allow` would make it; of the next connection.
  void be(Role role, std::uint8_t rank = 0) {
    peer_.role = role;
    peer_.rank = rank;
  }
  void disconnect();
  /// A new connection, from another port of the same address; none where no gateway runs.
  void connect();
  [[nodiscard]] bool connected() const;
  /// Silent for ever, and the gateway believes the connection alive; it still obeys what is on its way. connect() makes
  /// another one.
  void vanish();
  /// The gateway's system gives up what has vanished (TCP keepalive).
  void give_up_vanished();

 private:
  friend class ServedPort;
  class Connection;
  void lose_connections();
  RequestNumber begin(const std::vector<std::uint8_t>& pdu);
  Answer awaited(RequestNumber number);
  [[nodiscard]] const modbus_tcp::ListenerSettings& settings() const;
  [[nodiscard]] std::uint16_t base() const;

  ServedPort& port_;
  ManualRuntime& runtime_;
  std::optional<modbus_tcp::ListenerSettings> listener_;
  modbus_tcp::Peer peer_;
  std::unique_ptr<Connection> connection_;
  std::vector<std::unique_ptr<Connection>> vanished_;
  std::map<RequestNumber, Answer> answers_;
  RequestNumber last_ = 0;
};

}  // namespace axisgate::test::obey
