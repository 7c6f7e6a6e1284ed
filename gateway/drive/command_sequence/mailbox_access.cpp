// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/command_sequence/mailbox_access.hpp"

#include <algorithm>

namespace axisgate::drive {
namespace {

// What the drive said, as CiA 301 would have said it.
std::uint32_t abort_code(const model::DriveModel& drive, std::uint32_t detail) {
  constexpr std::uint32_t kGeneral = 0x08000000;
  if (model::is_canopen(drive) || detail == kNoSuchObject) return detail;
  return drive.resync.by_length && detail == kModbusIllegalAddress ? kNoSuchObject : kGeneral;
}

/// Of an answer that does not say how many bytes it has: the profile's, where it has the object.
std::uint8_t unsaid_width(const model::DriveModel& drive, const ObjectRequest& request) {
  if (!model::is_canopen(drive)) return 0;
  const model::ObjectId id = drive.find({request.index, request.subindex});
  if (id != model::kNoObject) return drive.object(id).size;
  const bool counted = request.count == 1 || request.count == 2 || request.count == 4;
  return request.size == 0 && counted ? static_cast<std::uint8_t>(request.count) : request.size;
}

}  // namespace

bool MailboxAccess::is_needless(const AxisCore& core, const ObjectRequest& request) {
  const model::ObjectId id = core.drive.find({request.index, request.subindex});
  if (!request.write || id == model::kNoObject) return false;
  const model::ObjectDef& object = core.object(id);
  const bool wears = object.nvm != model::Nvm::no && !object.trigger && object.size == request.size;
  return wears && core.store[id].cached && core.store[id].number == object.number(request.data);
}

bus::Exchange MailboxAccess::next(const model::DriveModel& drive, const ObjectRequest& request) const {
  bus::Exchange exchange{drive.node,
                         request.write ? bus::Access::write : bus::Access::read,
                         {request.index, request.subindex},
                         request.size,
                         request.write ? wire_bits(request.data, request.size) : 0};
  if (request.size == 0 && drive.resync.by_length)
    exchange.size = static_cast<std::uint8_t>(request.count == 0 ? 2 : request.count);
  if (!request.write) exchange.unsaid = unsaid_width(drive, request);
  if (request.size == 0 && model::is_canopen(drive)) {
    exchange.part = chain_open_ ? bus::Part::next : bus::Part::first;
    if (!chain_open_) exchange.bytes = request.bytes;
  }
  return exchange;
}

Outcome MailboxAccess::take(const model::DriveModel& drive, const ObjectRequest& request,
                            const bus::ExchangeResult& result, BatchResult& answer) {
  if (result.code != Errc::ok) {
    if (result.code == Errc::refused_by_drive) answer.abort_code = abort_code(drive, result.detail);
    return {result.code, result.detail};
  }
  chain_open_ = result.more;
  done_ = !chain_open_;
  if (chain_open_ || request.write) return {Errc::ok, 0};
  if (result.bytes) {
    answer.object_bytes = result.bytes;
    return {Errc::ok, 0};
  }
  // Neighbours may have been read in the same request.
  const ObjectAddress asked{request.index, request.subindex};
  const auto field = std::ranges::find_if(result.fields, [&](const bus::ReplyField& f) { return f.object == asked; });
  if (field == result.fields.end()) return {Errc::bad_reply, 0};
  answer.object_data = field->raw;
  answer.object_size = field->size;
  return {Errc::ok, 0};
}

}  // namespace axisgate::drive
