// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/read/references.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace axisgate::modbus_tcp {
namespace {

constexpr auto kFunction = static_cast<Byte>(Function::encapsulated_interface);
/// CiA 301: "general error", for a refusal without a code of its own.
constexpr std::uint32_t kAbortGeneral = 0x08000000;

ObjectKey key_of(const GeneralReference& reference, AxisNumber axis) {
  return {axis, reference.index, reference.subindex};
}

/// A content of 1, 2 or 4 bytes is a number; any other is sent as the bytes it is.
void put_content(ObjectRequest& object, std::vector<Byte> content) {
  const std::size_t size = content.size();
  if (size == 1 || size == 2 || size == 4) {
    object.size = static_cast<std::uint8_t>(size);
    object.data = load_le(content, 0, size);
  } else {
    object.bytes = std::make_shared<const std::vector<Byte>>(std::move(content));
  }
}

/// The content that was read, whatever its length.
ObjectBytes content_of(const BatchResult& result) {
  if (result.object_size == 0) {
    return result.object_bytes != nullptr ? result.object_bytes : std::make_shared<const std::vector<Byte>>();
  }
  std::vector<Byte> bytes(std::min<std::size_t>(result.object_size, 4));
  store_le(bytes, 0, bytes.size(), result.object_data);
  return std::make_shared<const std::vector<Byte>>(std::move(bytes));
}

/// The part of `content` that is asked for, as far as it fits. "More follows" in the object, not in what was asked for:
/// by it a client that reads in steps of its own knows when to stop.
Pdu read_reply_of(const GeneralReference& reference, Bytes content) {
  const Bytes rest = content.subspan(reference.start);
  std::size_t size = std::min(rest.size(), room_for_data(reference));
  if (reference.count != 0) size = std::min<std::size_t>(size, reference.count);
  return reference_reply(reference, rest.first(size), size < rest.size());
}

Pdu failure(const BatchResult& result) {
  if (result.outcome.code != Errc::refused_by_drive) {
    return exception_pdu(kFunction, modbus_exception(result.outcome.code));
  }
  return abort_pdu(result.abort_code != 0 ? result.abort_code : kAbortGeneral);
}

Pdu answer_object_read(const GeneralReference& reference, const ObjectKey& key,
                       const std::optional<BatchResult>& result, ObjectBuffers& buffers, Instant now) {
  if (result) {
    // What was read before is older than this, also where this failed.
    buffers.forget(key);
    if (result->outcome.code != Errc::ok) return failure(*result);
    const ObjectBytes content = content_of(*result);
    buffers.keep(key, content, now);
    return read_reply_of(reference, *content);
  }
  const ObjectBytes kept = buffers.kept(key, now);
  if (kept == nullptr || reference.start >= kept->size()) {
    return exception_pdu(kFunction, ModbusException::illegal_data_value);
  }
  return read_reply_of(reference, *kept);
}

}  // namespace

ReferencePlan plan_reference(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  const GeneralReference& reference = *request.reference;
  if (onlooker.role < (reference.write ? Role::engineer : Role::viewer)) return {.refused = Errc::role_forbidden};
  const AxisImage* axis = view.axis_of_node(reference.node, onlooker.image);
  if (axis == nullptr) return {.refused = Errc::no_path};

  ReferencePlan plan{.axis = axis->number};
  ObjectRequest object{.write = reference.write, .index = reference.index, .subindex = reference.subindex};
  if (reference.write) {
    const ObjectKey key = key_of(reference, plan.axis);
    if (reference.more_follows) {
      if (!client.objects.add_part(key, reference.start, request.data, onlooker.now)) plan.refused = Errc::bad_value;
      return plan;
    }
    auto content = client.objects.add_last(key, reference.start, request.data, onlooker.now);
    if (!content) return {.refused = Errc::bad_value};
    put_content(object, std::move(*content));
  } else {
    if (reference.start != 0) return plan;
    object.count = reference.count;
  }
  WriteBatch& batch = plan.batch.emplace(client.new_batch(onlooker.role));
  batch.claims = batch.reclaims = reference.write;
  batch.object = std::move(object);
  return plan;
}

Pdu answer_reference(const Request& request, AxisNumber axis, const std::optional<BatchResult>& result, Client& client,
                     Instant now) {
  const GeneralReference& reference = *request.reference;
  const ObjectKey key = key_of(reference, axis);
  if (!reference.write) return answer_object_read(reference, key, result, client.objects, now);
  if (!result) return reference_reply(reference, {}, reference.more_follows);
  // Whatever came of it, what was read before may no longer be so.
  client.objects.forget(key);
  return result->outcome.code == Errc::ok ? reference_reply(reference, {}, false) : failure(*result);
}

}  // namespace axisgate::modbus_tcp
