// SPDX-License-Identifier: Apache-2.0
// What a serial CAN adapter says, and the records between the gateway and its DDS process.
#include "adapters/can/lawicel_session.hpp"
#include "gateway/upstream/dds_link/records.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"

namespace axisgate::fuzz {
namespace {

using namespace std::chrono_literals;

/// The decoder hands its lines to a session, between frames that are sent and time that passes.
void lawicel(Input input) {
  can::LawicelDecoder decoder;
  can::LawicelSession session({.lawicel = true, .path = "/dev/can"}, 500'000);
  Instant now = Instant{} + 1h;
  session.on_port_up(now);
  std::size_t came = 0;
  while (input.more()) {
    switch (input.below(8)) {
      case 0: {
        can::CanFrame frame = can::data_frame(0, input.bytes(input.below(9)));
        frame.extended = input.yes();
        frame.id = input.number() & (frame.extended ? can::kMaxExtendedId : can::kMaxStandardId);
        can::LawicelDecoder back;
        std::optional<can::LawicelLine> line;
        for (const char byte : can::lawicel_text(frame)) line = back.push(static_cast<Byte>(byte));
        must(line && line->frame == frame, "a frame comes back as it was sent");
        session.send(frame, input.yes(), now);
        break;
      }
      case 1:
        now += std::chrono::milliseconds(input.byte());
        session.on_deadline(now);
        break;
      case 2:
        if (input.below(16) == 0) {
          session.on_port_down("pulled");
          decoder.clear();
          session.on_port_up(now);
        }
        break;
      case 3:
        if (input.below(16) == 0) session.on_babble(now);
        break;
      default:
        for (const Byte byte : input.bytes(1 + input.below(40))) {
          ++came;
          const auto line = decoder.push(byte);
          if (!line) continue;
          must(line->text.size() <= can::kMaxLawicelLine, "a line has its bound");
          must(line->frame.size <= 8, "a frame has 8 bytes at most");
          session.on_line(*line, now);
        }
        break;
    }
    static_cast<void>(session.take_output());
    must(session.up() || session.due(now) != kNever || !session.why().empty(), "what is not up is tried again");
  }
  must(decoder.bad_bytes() <= came, "no more bytes are counted than came");
}

void dds_records(Bytes bytes) {
  // Of the version that there is: a corpus of an older one would be refused by its first byte.
  std::vector<Byte> packet(bytes.begin(), bytes.end());
  if (!packet.empty()) packet.front() = dds::kLinkVersion;
  const dds::Decoded decoded = dds::decode(packet);
  if (decoded.error != dds::DecodeError::none) return;
  const std::vector<Byte> again = dds::encode(decoded.record);
  must(again.size() <= dds::kMaxPacket, "a record fits a packet");
  const dds::Decoded twice = dds::decode(again);
  must(twice.error == dds::DecodeError::none, "what was encoded is decoded");
  // By their bytes: NaN is no number's equal.
  must(dds::encode(twice.record) == again, "and says the same");
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_lawicel(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::lawicel(axisgate::fuzz::Input(data, size));
  return 0;
}
int axisgate_fuzz_dds_records(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::dds_records({data, size});
  return 0;
}
