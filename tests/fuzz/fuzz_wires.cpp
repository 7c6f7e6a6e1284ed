// SPDX-License-Identifier: Apache-2.0
// Each protocol's wire on a link whose far end is the input: exchanges, their end, time, losses of the link and
// whatever comes, in any order. What wire.hpp promises of all of them is held against each.
#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_fields.hpp"
#include "adapters/keya/keya_serial_exchange.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/unit/bus/scripted_links.hpp"

namespace axisgate::fuzz {
namespace {

using namespace std::chrono_literals;
using bus::Exchange;

/// What the bus would hear, and its promises.
class Listening final : public bus::WireEvents {
 public:
  void on_wire_up() override { up = true; }
  void on_wire_down(std::string_view why) override {
    must(!why.empty(), "a loss has its reason");
    up = false;
    outstanding.reset();
  }
  void on_reply(const bus::ExchangeResult& result) override {
    must(!sending, "nothing is answered from inside send()");
    must(outstanding.has_value(), "at most one reply for each exchange, and none after it was given up");
    for (const bus::ReplyField& field : result.fields)
      must(field.size == 1 || field.size == 2 || field.size == 4, "a value has 1, 2 or 4 bytes");
    must(!result.bytes || result.bytes->size() <= kMaxObjectBytes, "a long object has its bound");
    must(result.code == Errc::ok || result.fields.empty(), "what was refused has no value");
    goes_on = result.more ? outstanding : std::nullopt;
    outstanding.reset();
  }
  void on_unsolicited(const bus::UnsolicitedEvent& event) override {
    must(!sending, "nothing is told from inside send()");
    must(event.fields.size() <= bus::kMaxReplyFields, "process data have their bound");
  }

  bool up = false;
  bool sending = false;
  std::optional<Exchange> outstanding;
  std::optional<Exchange> goes_on;  ///< a chain whose next part may be asked for
};

/// `exchange`: the one that a number names; `bring`: something comes from the far end; `cut`: the link is lost and
/// back.
struct Far {
  std::function<Exchange(Input&)> exchange;
  std::function<void(Input&)> bring;
  std::function<void(bool up)> link;
};

class WirePlay {
 public:
  test::ManualRuntime runtime;
  Log log{[](LogLevel, std::string_view, std::string_view) {}};
  Listening heard;
  std::unique_ptr<bus::Wire> wire;

  void run(Input input, const Far& far) {
    wire->start(heard);
    wire->set_decode(input.yes());  // each frame in words
    far.link(true);
    runtime.run_due();
    for (int steps = 0; input.more() && steps < 4096; ++steps) step(input, far);
    const bus::Statistics counted = wire->statistics();
    must(counted.dropped_bytes <= brought_, "no more bytes are dropped than came");
  }
  void came(std::size_t bytes) { brought_ += bytes; }

 private:
  void step(Input& input, const Far& far) {
    switch (input.below(8)) {
      case 0:
      case 1:
        send(far.exchange(input));
        break;
      case 2:
        if (heard.outstanding && input.yes()) {
          heard.outstanding.reset();
          wire->abandon();
        } else if (heard.goes_on) {
          Exchange next = *heard.goes_on;
          next.part = bus::Part::next;
          send(next);
        }
        break;
      case 3:
        runtime.advance_by(std::chrono::milliseconds(input.byte()));
        break;
      case 4:
        if (input.below(16) == 0) {
          far.link(false);
          far.link(true);
        }
        runtime.run_due();
        break;
      default:
        far.bring(input);
        break;
    }
  }
  void send(const Exchange& exchange) {
    if (!heard.up || heard.outstanding) return;
    heard.outstanding = exchange;
    heard.goes_on.reset();
    heard.sending = true;
    wire->send(exchange);
    heard.sending = false;
  }

  std::size_t brought_ = 0;
};

Exchange exchange_of(std::uint8_t node, std::uint16_t index, std::uint8_t sub, std::uint8_t size, bool write,
                     std::uint32_t raw) {
  Exchange exchange;
  exchange.node = node;
  exchange.access = write ? bus::Access::write : bus::Access::read;
  exchange.object = {index, sub};
  exchange.size = size;
  exchange.raw = raw;
  return exchange;
}

template <typename Link>
void link_of(Link& link, bool up) {
  if (up) {
    link.events->on_link_up();
  } else {
    link.events->on_link_down("pulled");
  }
}

can::CanFrame any_frame(Input& input, const std::vector<std::uint32_t>& ids, bool extended) {
  const std::uint8_t head = input.byte();
  const std::uint32_t id = head < 240 ? ids[head % ids.size()] : input.number() & can::kMaxStandardId;
  can::CanFrame frame = can::data_frame(0, input.bytes(input.below(9)));
  frame.id = id;
  frame.extended = extended && head < 240;
  frame.remote = head > 250;
  return frame;
}

void canopen(Input input) {
  WirePlay play;
  auto link = std::make_unique<test::ScriptedCanLink>();
  test::ScriptedCanLink& far = *link;
  play.wire = canopen::make_canopen_wire(
      {.name = "can0",
       .own_heartbeat = 100ms,
       .nodes = {{.node = 1, .heartbeat = 200ms, .sdo_block = true}, {.node = 2, .guard_time = 100ms}}},
      std::move(link), play.runtime, play.log);
  play.wire->map_process_data(1, 1, {{{0x6041, 0}, 2}, {{0x6064, 0}, 4}});
  const auto exchange = [](Input& from) {
    const std::uint8_t what = from.byte();
    Exchange out = exchange_of((what & 1) != 0 ? 1 : 2, static_cast<std::uint16_t>(0x2000 + (what >> 1) % 3), 0,
                               (what & 8) != 0 ? 4 : 2, (what & 16) != 0, from.number());
    if ((what & 0xE0) == 0xE0) {
      out.access = bus::Access::command;
      out.raw = 0x80;
    } else if ((what & 0x20) != 0) {
      out.part = bus::Part::first;
      out.size = 0;
      if (out.access == bus::Access::write) out.bytes = std::make_shared<const std::vector<Byte>>(1 + from.byte());
    }
    return out;
  };
  const std::vector<std::uint32_t> ids{0x581, 0x581, 0x582, 0x701, 0x702, 0x081, 0x082, 0x181, 0x182, 0x281, 0x000};
  play.run(input,
           {exchange, [&](Input& from) { far.events->on_frame(any_frame(from, ids, false), play.runtime.now()); },
            [&](bool up) { link_of(far, up); }});
}

void keya_can(Input input) {
  WirePlay play;
  auto link = std::make_unique<test::ScriptedCanLink>();
  test::ScriptedCanLink& far = *link;
  play.wire = keya::make_keya_can_wire({.name = "can1", .nodes = {1, 2}}, std::move(link), play.runtime, play.log);
  const auto exchange = [](Input& from) {
    const std::uint8_t what = from.byte();
    const bool write = (what & 1) != 0;
    return exchange_of((what & 2) != 0 ? 1 : 2,
                       static_cast<std::uint16_t>(write ? 0x2000 + ((what >> 2) & 15) : 0x2100 + ((what >> 2) & 15)),
                       static_cast<std::uint8_t>(from.below(4)), 4, write, from.number());
  };
  const std::vector<std::uint32_t> ids{0x05800001, 0x05800002, 0x07000001, 0x07000002, 0x06000001};
  play.run(input, {exchange, [&](Input& from) { far.events->on_frame(any_frame(from, ids, true), play.runtime.now()); },
                   [&](bool up) { link_of(far, up); }});
}

/// A line of bytes.
template <typename Make>
void on_a_line(Input input, Make make, const std::function<Exchange(Input&)>& exchange) {
  WirePlay play;
  auto link = std::make_unique<test::ScriptedLink>();
  test::ScriptedLink& far = *link;
  play.wire = make(std::move(link), play);
  play.run(input, {exchange,
                   [&](Input& from) {
                     const Bytes bytes = from.bytes(1 + from.below(24));
                     play.came(bytes.size());
                     far.events->on_bytes(bytes);
                   },
                   [&](bool up) { link_of(far, up); }});
}

void keya_serial(Input input, keya::KeyaLine line) {
  on_a_line(
      input,
      [&](auto link, WirePlay& play) {
        return keya::make_keya_serial_wire({.name = "belt", .line = line, .baud = 115200}, std::move(link),
                                           play.runtime, play.log);
      },
      [](Input& from) {
        const std::uint8_t what = from.byte();
        Exchange out = exchange_of((what & 1) != 0 ? 1 : 2, static_cast<std::uint16_t>(0x2100 + ((what >> 1) & 15)), 0,
                                   2, false, 0);
        if ((what & 0x60) != 0) return out;
        // The whole control frame of both motors.
        out = exchange_of(out.node, keya::kValueIndex, 2, 4, true, from.number());
        out.more.push_back({{keya::kOnIndex, 1}, 1, from.byte()});
        out.more.push_back({{keya::kValueIndex, 1}, 4, from.number()});
        out.more.push_back({{keya::kOnIndex, 2}, 1, from.byte()});
        return out;
      });
}

void kinco(Input input) {
  on_a_line(
      input,
      [](auto link, WirePlay& play) {
        return std::make_unique<axisgate::kinco::KincoWire>("lift", std::move(link), play.runtime, play.log);
      },
      [](Input& from) {
        const std::uint8_t what = from.byte();
        static constexpr std::array<std::uint16_t, 4> kIndexes{0x6040, 0x6041, 0x6064, 0x607A};
        static constexpr std::array<std::uint8_t, 3> kSizes{1, 2, 4};
        return exchange_of((what & 1) != 0 ? 1 : 2, kIndexes[(what >> 1) & 3], 0, kSizes[(what >> 3) % 3],
                           (what & 0x80) != 0, from.number());
      });
}

void modbus_rtu(Input input) {
  WirePlay play;
  auto link = std::make_unique<test::ScriptedRtuLink>();
  test::ScriptedRtuLink& far = *link;
  const std::vector<axisgate::modbus_rtu::RtuNode> nodes{
      {.node = 1, .low_word_first = true, .error_functions = {0x81}}, {.node = 2, .broadcast = 255}, {.node = 3}};
  play.wire = std::make_unique<axisgate::modbus_rtu::RtuWire>(
      "line", nodes, axisgate::modbus_rtu::LineSpeed{.baud = 19200, .parity_bits = 0}, std::move(link), play.runtime,
      play.log);
  const auto exchange = [](Input& from) {
    const std::uint8_t what = from.byte();
    const bool write = (what & 0x80) != 0;
    static constexpr std::array<std::uint8_t, 3> kSizes{1, 2, 4};
    Exchange out = exchange_of(static_cast<std::uint8_t>(1 + (what & 3) % 3),
                               static_cast<std::uint16_t>(0x3200 + ((what >> 2) & 3)), 0, kSizes[(what >> 4) % 3],
                               write, from.number());
    if (write && (what & 0x60) == 0x60) out.node = 255;
    for (std::uint8_t i = from.byte() & 7; !write && i > 0 && out.more.size() < 7; --i)
      out.more.push_back({{static_cast<std::uint16_t>(0x3210 + 2 * out.more.size()), 0}, 2});
    return out;
  };
  const auto bring = [&](Input& from) {
    const std::uint8_t how = from.byte();
    const Bytes frame = from.bytes(2 + from.below(40));
    play.came(frame.size());
    // As a link does: no frame is shorter than an error reply, nor longer than the longest there is.
    if ((how & 1) != 0 || frame.size() < axisgate::modbus_rtu::kErrorFrame) {
      far.events->on_bad_frame(far.newest, frame.size());
    } else {
      far.events->on_frame((how & 2) != 0 ? far.newest - 1 : far.newest, frame);
    }
  };
  play.run(input, {exchange, bring, [&](bool up) { link_of(far, up); }});
}

}  // namespace
}  // namespace axisgate::fuzz

using axisgate::fuzz::Input;

int axisgate_fuzz_canopen(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::canopen(Input(data, size));
  return 0;
}
int axisgate_fuzz_keya_can(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::keya_can(Input(data, size));
  return 0;
}
int axisgate_fuzz_keya_rs232(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::keya_serial(Input(data, size), axisgate::keya::KeyaLine::rs232);
  return 0;
}
int axisgate_fuzz_keya_rs485(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::keya_serial(Input(data, size), axisgate::keya::KeyaLine::rs485);
  return 0;
}
int axisgate_fuzz_kinco(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::kinco(Input(data, size));
  return 0;
}
int axisgate_fuzz_modbus_rtu(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::modbus_rtu(Input(data, size));
  return 0;
}
