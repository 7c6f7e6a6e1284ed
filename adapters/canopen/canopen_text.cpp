// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/canopen_text.hpp"

#include <fmt/format.h>

#include "adapters/bus/node_state.hpp"
#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/emergency.hpp"
#include "adapters/canopen/nmt.hpp"
#include "adapters/canopen/sdo/sdo_codec.hpp"
#include "gateway/core/name_table.hpp"

namespace axisgate::canopen {

namespace {

using Kind = SdoReply::Kind;

/// As many digits as there are bytes.
std::string value_text(Bytes bytes) {
  if (bytes.empty() || bytes.size() > kExpeditedBytes) return hex_text(bytes);
  return fmt::format("0x{:0{}X}", load_le(bytes, 0, bytes.size()), 2 * bytes.size());
}

std::string_view command_text(NmtCommand command) {
  static constexpr auto kNames = names_of<NmtCommand>({
      {NmtCommand::start, "start"},
      {NmtCommand::stop, "stop"},
      {NmtCommand::enter_pre_operational, "pre-operational"},
      {NmtCommand::reset_node, "reset"},
      {NmtCommand::reset_communication, "reset communication"},
  });
  return kNames.of(command);
}

std::string nmt_text(Bytes bytes) {
  const auto command = bytes.size() < 2 ? std::nullopt : nmt_command(bytes[0]);
  if (!command) return "NMT, no command";
  return fmt::format("NMT {} {}", command_text(*command),
                     bytes[1] == 0 ? std::string("all nodes") : fmt::format("node {}", bytes[1]));
}

std::string error_control_text(const can::CanFrame& frame) {
  if (frame.remote) return "guarding";
  const auto heard = decode_error_control(frame.bytes());
  if (!heard) return "error control, no state";
  if (heard->boot_up) return "boot-up";
  return fmt::format("{}{}", bus::text(heard->state), heard->toggle ? ", toggled" : "");
}

std::string emergency_text(Bytes bytes) {
  const auto emergency = decode_emergency(0, bytes);
  if (!emergency) return "EMCY, no code";
  return fmt::format("EMCY 0x{:04X}, register 0x{:02X}, {}", emergency->code, emergency->error_register,
                     hex_text(emergency->vendor));
}

std::string reply_text(Bytes bytes) {
  const auto reply = decode_reply(bytes);
  if (!reply) return "SDO, no reply";
  const std::string object = object_text(reply->object);
  switch (reply->kind) {
    case Kind::downloaded:
      return "SDO written " + object;
    case Kind::segment_downloaded:
      return "SDO segment written";
    case Kind::value:
      return "SDO value " + object + " = " + value_text(reply->data);
    case Kind::upload_begins:
      return "SDO segments of " + object + " follow";
    case Kind::segment:
      return "SDO segment " + hex_text(bytes.subspan(1));
    case Kind::aborted:
      return fmt::format("SDO abort {}: 0x{:08X}", object, reply->code);
    case Kind::block_download_begins:
      return fmt::format("SDO takes {} in blocks of {}", object, reply->segments);
    case Kind::block_received:
      return fmt::format("SDO block received to segment {}", reply->sequence);
    case Kind::block_downloaded:
      return "SDO blocks written";
    case Kind::block_upload_begins:
      return "SDO blocks of " + object + " follow";
    case Kind::block_upload_ends:
      return fmt::format("SDO blocks end, CRC 0x{:04X}", reply->checksum);
  }
  return "SDO";
}

/// What we send ourselves; of a segment in a block nothing tells it from another request.
std::string request_text(Bytes bytes) {
  if (bytes.size() < kSdoFrameBytes) return "SDO, no request";
  const std::string object = object_text({load_le16(bytes, 1), bytes[3]});
  switch (bytes[0]) {
    case 0x40:
      return "SDO read " + object;
    case 0x23:
    case 0x27:
    case 0x2B:
    case 0x2F:
      return "SDO write " + object + " = " + value_text(bytes.subspan(4, kExpeditedBytes - ((bytes[0] >> 2) & 0x03U)));
    case 0x21:
      return fmt::format("SDO write {}, {} bytes in segments", object, load_le(bytes, 4, 4));
    case 0x60:
    case 0x70:
      return "SDO read next segment";
    case 0x80:
      return fmt::format("SDO abort {}: 0x{:08X}", object, load_le(bytes, 4, 4));
    case 0xA1:
      return "SDO blocks read";
    case 0xA2:
      return fmt::format("SDO block read to segment {}", bytes[1]);
    case 0xA3:
      return "SDO read first block";
    case 0xA4:
      return "SDO read " + object + " in blocks";
    case 0xC6:
      return fmt::format("SDO write {}, {} bytes in blocks", object, load_le(bytes, 4, 4));
    default:
      return (bytes[0] & 0xE3) == 0xC1 ? "SDO blocks end" : "SDO write segment " + hex_text(bytes.subspan(1));
  }
}

}  // namespace

std::string object_text(ObjectAddress object) { return fmt::format("{:04X}:{:02X}", object.index, object.sub); }

std::string describe(const can::CanFrame& frame) {
  const auto id = frame.extended ? std::nullopt : cob_id(frame.id);
  if (!id) return "not CANopen";
  const Bytes bytes = frame.bytes();
  if (id->service == Service::nmt) return nmt_text(bytes);
  if (id->service == Service::sync) return "SYNC";
  const std::string node = fmt::format("node {}", id->node);
  if (id->service == Service::error_control) return node + ": " + error_control_text(frame);
  if (frame.remote) return node + ": remote frame";
  switch (id->service) {
    case Service::sdo_request:
      return node + ": " + request_text(bytes);
    case Service::sdo_reply:
      return node + ": " + reply_text(bytes);
    case Service::emergency:
      return node + ": " + emergency_text(bytes);
    case Service::tpdo:
      return fmt::format("{}: TPDO {}", node, id->number);
    default:
      return fmt::format("{}: RPDO {}", node, id->number);
  }
}

}  // namespace axisgate::canopen
