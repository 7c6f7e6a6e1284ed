// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/sdo_client.hpp"

#include <cassert>

namespace axisgate::canopen {

namespace {

using Kind = SdoReply::Kind;

std::array<Byte, kExpeditedBytes> value_bytes(const bus::Exchange& exchange) {
  std::array<Byte, kExpeditedBytes> bytes{};
  store_le(bytes, 0, exchange.size, exchange.raw);
  return bytes;
}

bool acknowledges_write(const SdoReply& reply) {
  return reply.kind == Kind::downloaded || reply.kind == Kind::segment_downloaded ||
         reply.kind == Kind::block_downloaded;
}

bool is_write(const bus::Exchange& exchange) { return exchange.access == bus::Access::write; }

/// Both answer the same request: the devices may differ in what they say.
bool same_request(const SdoReply& a, const SdoReply& b) {
  if (names_object(a.kind) != names_object(b.kind)) return false;
  return names_object(a.kind) ? a.object == b.object : a.kind == b.kind && a.toggle == b.toggle;
}

}  // namespace

bus::ObjectAddress SdoClient::object_of(const Transfer& transfer) {
  return std::visit([](const auto& t) { return t.object(); }, transfer);
}

SdoStep SdoClient::begin(const bus::Exchange& exchange) {
  assert(!outstanding_);
  Server& server = servers_.at(exchange.node);
  SdoStep step;
  if (exchange.part == bus::Part::next) {
    const bool open = server.transfer && std::holds_alternative<SdoDownload>(*server.transfer) == is_write(exchange) &&
                      object_of(*server.transfer) == exchange.object;
    if (!open) {
      step = over(refused(kAbortDeviceState));
      step.frames = interrupt(exchange.node);
      return step;
    }
    step.frames = std::visit([](auto& t) { return t.next(); }, *server.transfer);
  } else {
    step.frames = interrupt(exchange.node);
    const bool whole = exchange.part == bus::Part::whole;
    if (!is_write(exchange)) {
      server.transfer.emplace(SdoUpload(exchange.object, whole, server.block));
    } else if (exchange.bytes) {
      server.transfer.emplace(SdoDownload(exchange.object, *exchange.bytes, server.block));
    } else {
      server.transfer.emplace(
          SdoDownload(exchange.object, Bytes(value_bytes(exchange)).first(exchange.size), server.block));
    }
    const SdoFrames first = std::visit([](auto& t) { return t.begin(); }, *server.transfer);
    step.frames.insert(step.frames.end(), first.begin(), first.end());
  }
  outstanding_ = exchange.node;
  return step;
}

SdoClient::Heard SdoClient::take(std::uint8_t node, Bytes bytes, Instant now) {
  Server& server = servers_.at(node);
  std::optional<SdoStep> step;
  if (outstanding_ == node) step = std::visit([&](auto& t) { return t.take(bytes); }, *server.transfer);
  if (!step) return not_mine(server, outstanding_ == node, bytes, now);
  if (step->over) {
    outstanding_.reset();
    server.finished.reset();
    // Of a block any number of frames may come, and a server may answer an abort: none of those is one too many.
    const bool in_blocks = std::visit([](const auto& t) { return t.in_blocks(); }, *server.transfer);
    const bool counts = !in_blocks && step->frames.empty();
    if (const auto reply = decode_reply(bytes); reply && counts) server.finished = Finished{*reply, now};
    if (!step->over->more) server.transfer.reset();
  }
  return {Heard::What::mine, *std::move(step)};
}

SdoClient::Heard SdoClient::not_mine(Server& server, bool waited_for, Bytes bytes, Instant now) const {
  const auto reply = decode_reply(bytes);
  if (!reply) return {Heard::What::bad};
  // The server has waited for the next part for longer than it wants to.
  const bool paused = server.transfer && !waited_for;
  if (reply->kind == Kind::aborted && paused && object_of(*server.transfer) == reply->object) {
    server.transfer.reset();
    server.finished.reset();
    return {Heard::What::late};
  }
  // One more than was asked for; but where an earlier request was given up, the first one may have been its answer.
  const bool again =
      server.finished && now - server.finished->at <= duplicate_window_ && same_request(server.finished->reply, *reply);
  if (again && server.owed == 0) return {Heard::What::second_reply, {}, acknowledges_write(*reply)};
  if (server.owed > 0) --server.owed;
  return {Heard::What::late, {}, acknowledges_write(*reply)};
}

SdoFrames SdoClient::abandon() {
  if (!outstanding_) return {};
  Server& server = servers_.at(*outstanding_);
  const bus::ObjectAddress object = object_of(*server.transfer);
  outstanding_.reset();
  server.transfer.reset();
  if (server.owed < UINT8_MAX) ++server.owed;
  return {abort_frame(object, kAbortTimedOut)};
}

SdoFrames SdoClient::interrupt(std::uint8_t node) {
  Server& server = servers_.at(node);
  if (!server.transfer) return {};
  const bus::ObjectAddress object = object_of(*server.transfer);
  server.transfer.reset();
  server.finished.reset();
  return {abort_frame(object, kAbortDeviceState)};
}

void SdoClient::restarted(std::uint8_t node) {
  Server& server = servers_.at(node);
  server = Server{.block = server.block};
  if (outstanding_ != node) return;
  outstanding_.reset();
  server.owed = 1;  // a request that its boot-up has crossed is answered
}

void SdoClient::reset() {
  outstanding_.reset();
  for (Server& server : servers_) server = Server{.block = server.block};
}

}  // namespace axisgate::canopen
