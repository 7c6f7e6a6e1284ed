// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/object_batches.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::dds {
namespace {

bool known_size(std::uint8_t size) { return size == 0 || size == 1 || size == 2 || size == 4; }

std::uint32_t mask_of(std::uint8_t size) { return size >= 4 ? UINT32_MAX : (1U << (8U * size)) - 1U; }

/// As an unsigned number, or as a negative one that was made 32 bits wide.
bool fits(std::uint32_t value, std::uint8_t size) {
  const std::uint32_t mask = mask_of(size);
  const std::uint32_t sign_and_above = ~(mask >> 1U);
  return (value & ~mask) == 0 || (value & sign_and_above) == sign_and_above;
}

bool is_sound(const ObjectRequestRecord& record) {
  if (!known_size(record.size)) return false;
  if (!record.write) return true;
  return record.size == 0 ? !record.data.empty() && record.data.size() <= kMaxObjectBytes
                          : fits(record.value, record.size);
}

}  // namespace

PlannedObject plan_object(const ObjectRequestRecord& record, const WriteBatch& from, const AxisImage* axis) {
  if (from.role < (record.write ? Role::engineer : Role::viewer)) return Errc::role_forbidden;
  if (axis == nullptr) return Errc::no_path;
  if (!is_sound(record)) return Errc::bad_value;
  WriteBatch batch = from;
  batch.beats = true;
  batch.claims = record.write;
  batch.reclaims = from.reclaims && record.write;
  batch.command_id = static_cast<std::uint16_t>(record.request_id & 0xFFFFU);
  ObjectRequest request{record.write, record.index, record.subindex, record.size};
  if (record.write && record.size == 0) request.bytes = std::make_shared<const std::vector<Byte>>(record.data);
  if (record.write && record.size != 0) request.data = record.value & mask_of(record.size);
  batch.object = std::move(request);
  return batch;
}

ObjectReplyRecord object_reply(const ObjectRequestRecord& record, const BatchResult& result) {
  ObjectReplyRecord reply;
  reply.axis = record.axis;
  reply.request_id = record.request_id;
  reply.writer = record.writer;
  reply.result = dds_result(result.outcome.code);
  if (result.outcome.code != Errc::ok) {
    reply.detail = result.abort_code != 0 ? result.abort_code : result.outcome.detail;
    return reply;
  }
  if (record.write) return reply;
  constexpr std::size_t kOfAValue = sizeof(reply.value);
  if (result.object_bytes) {
    reply.data = *result.object_bytes;
    if (!reply.data.empty() && reply.data.size() <= kOfAValue) reply.value = load_le(reply.data, 0, reply.data.size());
    return reply;
  }
  reply.value = result.object_data;
  reply.data.resize(std::min<std::size_t>(result.object_size, kOfAValue));
  if (!reply.data.empty()) store_le(reply.data, 0, reply.data.size(), reply.value);
  return reply;
}

}  // namespace axisgate::dds
