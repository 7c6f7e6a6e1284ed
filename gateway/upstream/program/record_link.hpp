// SPDX-License-Identifier: Apache-2.0
// A program's end of the socket pair as records: those that its `encode` and `decode` know, one a packet.
// Promises all that LinkSocket does. Never lets a packet through that is no record.
#pragma once

#include <string>
#include <utility>

#include "gateway/upstream/program/link_socket.hpp"

namespace axisgate::program {

/// Record: of the program, with `encode(record)`; Decode: its `decode(bytes)`.
template <typename Record, link::Decoded<Record> (*Decode)(Bytes)>
class RecordLink : public LinkSocket {
 public:
  /// `name`: of the program, "axisgate-dds".
  RecordLink(int fd, std::string name, const std::string& hint = {}) : LinkSocket(fd, hint), name_(std::move(name)) {}

  struct Got {
    Received what = Received::nothing;
    Record record{};
    std::string problem{};  ///< of garbage
  };
  [[nodiscard]] Got receive() {
    LinkSocket::Packet packet = LinkSocket::receive();
    if (packet.what != Received::packet) return {packet.what, {}, std::move(packet.problem)};
    link::Decoded<Record> decoded = Decode(packet.bytes);
    if (decoded.error != link::DecodeError::none) return {Received::garbage, {}, text(decoded.error, name_)};
    return {Received::packet, std::move(decoded.record)};
  }
  bool send(const Record& record) { return LinkSocket::send(encode(record)); }

 private:
  std::string name_;
};

}  // namespace axisgate::program
