// SPDX-License-Identifier: Apache-2.0
// Modbus-TCP: the frames of a stream, and a whole session before an image and a command port.
#include <deque>

#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::fuzz {
namespace {

using modbus_tcp::MbapFramer;
using Verdict = MbapFramer::Verdict;

struct Read {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  std::vector<Byte> pdu;
  friend bool operator==(const Read&, const Read&) = default;
};

/// False: what follows is no frame.
bool take_frames(MbapFramer& framer, std::vector<Read>& out) {
  for (;;) {
    modbus_tcp::Frame frame;
    const Verdict verdict = framer.next(frame);
    if (verdict != Verdict::frame) return verdict != Verdict::malformed;
    must(!frame.pdu.empty() && frame.pdu.size() <= modbus_tcp::kMaxPdu, "a frame has a PDU of 1 to 253 bytes");
    out.push_back({frame.transaction, frame.unit, {frame.pdu.begin(), frame.pdu.end()}});
  }
}

void wire(Bytes stream) {
  MbapFramer whole, split;
  std::vector<Read> at_once, byte_by_byte;
  whole.push(stream);
  const bool good = take_frames(whole, at_once);
  bool still_good = true;
  for (std::size_t i = 0; i < stream.size() && still_good; ++i) {
    split.push(stream.subspan(i, 1));
    still_good = take_frames(split, byte_by_byte);
  }
  must(good == still_good && at_once == byte_by_byte, "frames do not depend on how the stream is cut");
  for (const Read& frame : at_once) {
    const auto request = modbus_tcp::decode_request(frame.pdu);
    if (const auto* good_one = std::get_if<modbus_tcp::Request>(&request)) {
      must(good_one->read_count <= modbus_tcp::kMaxReadBits, "no read is longer than a reply can be");
      if (good_one->writes() && !good_one->writes_coils() &&
          good_one->function != modbus_tcp::Function::mask_write_register)
        must(good_one->data.size() >= 2U * good_one->write_count, "all registers that are written are there");
    }
  }
}

/// One connection, whose requests, results, pauses and reads come in any order.
class SessionPlay {
 public:
  explicit SessionPlay(Input input)
      : input_(input), settings_(input_.byte()), plc_(desk_, static_cast<Role>(input_.below(4))) {
    desk_.port.slow = (settings_ & 1) != 0;
    desk_.settings.posted_writes = (settings_ & 2) != 0;
    desk_.settings.low_word_first = (settings_ & 4) != 0;
    desk_.settings.per_axis_units = (settings_ & 8) != 0;
    desk_.settings.float_numbers = (settings_ & 16) != 0;
    desk_.settings.staged_halves = (settings_ & 32) != 0;
    desk_.settings.offline_reads_fail = (settings_ & 64) != 0;
  }

  void run() {
    while (input_.more() && !plc_.session().finished()) step();
    if (foreign_bytes_) return;
    // All that was asked is answered, in its order, once the results are there.
    for (int i = 0; i < 4096 && !asked_.empty() && !plc_.session().finished(); ++i) {
      if (!desk_.port.waiting.empty()) desk_.port.finish_with({});
      take_reply();
    }
    must(asked_.empty() || plc_.session().finished(), "each request has its reply");
  }

 private:
  void step() {
    switch (input_.below(8)) {
      case 0:
        foreign_bytes_ = true;
        if (plc_.session().wants_input()) feed(input_.bytes(input_.byte()));
        break;
      case 1:
        if (!desk_.port.waiting.empty()) {
          BatchResult result;
          result.outcome = {static_cast<Errc>(input_.below(kErrcCount)), input_.number()};
          desk_.port.finish_with(result);
        }
        break;
      case 2:
        desk_.runtime.advance_by(std::chrono::milliseconds(16 * input_.byte()));
        if (plc_.session().next_deadline() <= desk_.runtime.now()) plc_.session().on_deadline(desk_.runtime.now());
        break;
      case 3:
        desk_.axis(1).link_state = static_cast<LinkState>(input_.below(6));
        break;
      case 4:
        take_reply();
        break;
      default:
        request();
        break;
    }
    must(plc_.session().output().size() <= modbus_tcp::kMaxPipelined * modbus_tcp::kMaxAdu,
         "no more than four replies wait for their client");
  }
  void request() {
    const auto unit = static_cast<std::uint8_t>(input_.below(7));
    const Bytes pdu = input_.bytes(1 + input_.below(60));
    if (pdu.empty() || !plc_.session().wants_input()) return;
    asked_.push_back(pdu[0]);
    feed(modbus_tcp::test::frame(++transaction_, unit, {pdu.begin(), pdu.end()}));
  }
  void feed(Bytes bytes) { plc_.session().on_bytes(bytes, desk_.runtime.now()); }
  void take_reply() {
    const Bytes output = plc_.session().output();
    if (output.empty()) return;
    must(output.size() >= 9, "a reply is a whole frame");
    const std::size_t size = 6U + load_be16(output, 4);
    must(output.size() >= size, "a reply is as long as it says");
    if (!foreign_bytes_) {
      must(!asked_.empty(), "nothing is answered that was not asked");
      must(load_be16(output, 0) == ++answered_, "replies come in request order");
      must((output[7] & 0x7F) == (asked_.front() & 0x7F), "a reply has its request's function");
      asked_.pop_front();
    }
    plc_.session().take_output(size, desk_.runtime.now());
  }

  Input input_;
  std::uint8_t settings_;
  modbus_tcp::test::Desk desk_;
  modbus_tcp::test::Line plc_;
  std::deque<Byte> asked_;
  std::uint16_t transaction_ = 0;
  std::uint16_t answered_ = 0;
  bool foreign_bytes_ = false;  ///< bytes of the input itself were in the stream: what they ask is not reckoned
};

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_modbus_wire(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::wire({data, size});
  return 0;
}

int axisgate_fuzz_modbus_session(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::SessionPlay(axisgate::fuzz::Input(data, size)).run();
  return 0;
}
