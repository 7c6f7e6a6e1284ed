// SPDX-License-Identifier: Apache-2.0
// A CANopen wire with a drive's SDO server behind it. `spoil` may change, drop or add replies on their way.
#pragma once

#include <functional>

#include "tests/unit/canopen/canopen_wire_stage.hpp"
#include "tests/unit/canopen/sdo_server.hpp"

namespace axisgate::test {

class SdoStage : public CanopenWireStage {
 protected:
  static constexpr std::uint16_t kObject = 0x2000;
  static constexpr int kMaxExchanges = 1000;

  void begin_with_blocks() {
    server.offers_block = true;
    begin({.name = "can0", .nodes = {{.node = 1, .sdo_block = true}, {.node = 2}}});
  }
  /// The server hears what was sent since the last time and answers, until there is nothing more to say.
  void serve() {
    while (served < link->sent.size()) {
      const CanFrame frame = link->sent[served++];
      if (frame.id != 0x601) continue;
      const Bytes bytes = frame.bytes();
      for (ByteRow& row : server.hear(ByteRow(bytes.begin(), bytes.end()))) {
        ++replies_sent;
        if (!spoil || spoil(row)) bring(can::data_frame(0x581, row));
      }
    }
  }
  /// One exchange; no value: it was not answered.
  std::optional<bus::ExchangeResult> exchange(const bus::Exchange& what) {
    const std::size_t before = replies.size();
    wire->send(what);
    serve();
    if (replies.size() == before) runtime.run_due();
    if (replies.size() == before) return std::nullopt;
    EXPECT_EQ(replies.size(), before + 1);
    return replies.back();
  }
  /// A chain to its end.
  std::optional<bus::ExchangeResult> transfer(const bus::Exchange& what) {
    auto result = exchange(what);
    exchanges = 1;
    while (result && result->more && ++exchanges < kMaxExchanges) result = exchange(next_of(what));
    return result;
  }

  SdoServer server;
  std::function<bool(ByteRow&)> spoil;  ///< false: the reply is lost
  std::size_t served = 0;
  int replies_sent = 0;
  int exchanges = 0;  ///< of the last transfer
};

}  // namespace axisgate::test
