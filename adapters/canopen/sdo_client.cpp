// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/sdo_client.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

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

constexpr Byte kAbort = 0x80;

std::size_t unsaid_width(const bus::Exchange& exchange) {
  if (exchange.unsaid != 0) return exchange.unsaid;
  return exchange.size != 0 ? exchange.size : kExpeditedBytes;
}

/// An abort that does not say of what.
bool names_nothing(Bytes bytes) {
  return bytes.size() >= kSdoFrameBytes && bytes[0] == kAbort && load_le16(bytes, 1) == 0 && bytes[3] == 0;
}

/// Both answer the same request: the devices may differ in what they say.
bool same_request(const SdoReply& a, const SdoReply& b) {
  if (names_object(a.kind) != names_object(b.kind)) return false;
  return names_object(a.kind) ? a.object == b.object : a.kind == b.kind && a.toggle == b.toggle;
}

}  // namespace

ObjectAddress SdoClient::object_of(const Transfer& transfer) {
  return std::visit([](const auto& t) { return t.object(); }, transfer);
}

bool SdoClient::Server::may_still_answer(ObjectAddress object) const {
  return gave_up_more || std::find(given_up.begin(), given_up.end(), object) != given_up.end();
}

void SdoClient::Server::give_up(ObjectAddress object) {
  if (may_still_answer(object)) return;
  if (given_up.size() == given_up.capacity())
    gave_up_more = true;
  else
    given_up.push_back(object);
}

void SdoClient::Server::answered(ObjectAddress object) {
  if (!may_still_answer(object)) given_up.clear();
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
      server.transfer.emplace(SdoUpload(exchange.object, whole, server.block, unsaid_width(exchange)));
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
  SdoFrame renamed{};
  if (names_nothing(bytes) && server.transfer && !server.may_still_answer()) {
    renamed = named(server, bytes);
    bytes = renamed;
  }
  std::optional<SdoStep> step;
  if (outstanding_ == node) step = std::visit([&](auto& t) { return t.take(bytes); }, *server.transfer);
  if (!step) return not_mine(server, outstanding_ == node, bytes, now);
  // A segment of a block may look like anything, but for the object that it is of.
  const auto reply = decode_reply(bytes);
  const bool of_asked = reply && names_object(reply->kind) && reply->object == object_of(*server.transfer);
  if (of_asked) server.answered(reply->object);
  if (step->over) {
    outstanding_.reset();
    server.stranger.reset();
    if (!step->frames.empty() && step->frames.front()[0] == kAbort) server.give_up(object_of(*server.transfer));
    server.finished.reset();
    // Of a block any number of frames may come, and a server may answer an abort: none of those is one too many.
    const bool in_blocks = std::visit([](const auto& t) { return t.in_blocks(); }, *server.transfer);
    const bool counts = !in_blocks && step->frames.empty();
    if (reply && counts) server.finished = Finished{*reply, now};
    if (!step->over->more) server.transfer.reset();
  }
  return {Heard::What::mine, *std::move(step)};
}

/// As the server would have said it that names what it aborts.
SdoFrame SdoClient::named(const Server& server, Bytes bytes) {
  return abort_frame(object_of(*server.transfer), load_le(bytes, 4, 4));
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
  const bool names = names_object(reply->kind) && reply->object != ObjectAddress{};
  if (waited_for && names && reply->object != object_of(*server.transfer) && !server.may_still_answer(reply->object))
    server.stranger = reply->object;
  if (server.owed > 0) --server.owed;
  return {Heard::What::late, {}, acknowledges_write(*reply)};
}

SdoClient::Abandoned SdoClient::abandon() {
  if (!outstanding_) return {};
  Server& server = servers_.at(*outstanding_);
  const ObjectAddress object = object_of(*server.transfer);
  Abandoned abandoned{{abort_frame(object, kAbortTimedOut)}};
  if (const auto stranger = std::exchange(server.stranger, std::nullopt))
    abandoned.instead = Instead{object, *stranger};
  server.give_up(object);
  outstanding_.reset();
  server.transfer.reset();
  if (server.owed < UINT8_MAX) ++server.owed;
  return abandoned;
}

SdoFrames SdoClient::interrupt(std::uint8_t node) {
  Server& server = servers_.at(node);
  if (!server.transfer) return {};
  const ObjectAddress object = object_of(*server.transfer);
  server.transfer.reset();
  server.finished.reset();
  server.give_up(object);
  return {abort_frame(object, kAbortDeviceState)};
}

void SdoClient::restarted(std::uint8_t node) {
  Server& server = servers_.at(node);
  const auto asked = outstanding_ == node ? std::optional(object_of(*server.transfer)) : std::nullopt;
  server = Server{.block = server.block};
  if (!asked) return;
  outstanding_.reset();
  server.owed = 1;  // a request that its boot-up has crossed is answered
  server.give_up(*asked);
}

void SdoClient::reset() {
  outstanding_.reset();
  for (Server& server : servers_) server = Server{.block = server.block};
}

}  // namespace axisgate::canopen
