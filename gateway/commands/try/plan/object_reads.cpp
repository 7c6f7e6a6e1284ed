// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/object_reads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace axisgate::commands {
namespace {

std::string place_text(const model::DriveModel& model, const model::ObjectDef& object) {
  if (model.protocol == "modbus-rtu") return fmt::format("register {}", object.address.index);
  return fmt::format("{:04X}.{:02X}", object.address.index, object.address.sub);
}

std::string type_text(const model::ObjectDef& object) {
  return model::type_name(object.size, object.is_signed, object.is_real);
}

bool has_two_words(const model::DriveModel& model, const model::ObjectDef& object) {
  return model.protocol == "modbus-rtu" && object.size == 4;
}

std::string refusal_text(const BatchResult& answer) {
  if (answer.outcome.code != Errc::refused_by_drive) return std::string(text(answer.outcome.code));
  return fmt::format("refused, {:#010x}", answer.abort_code);
}

void judge_range(const model::ObjectDef& object, ObjectRow& row) {
  if (object.printed.holds(*row.value)) return;
  row.remark = fmt::format("outside its range {} to {}", object.printed.min, object.printed.max);
  if (!row.other_order || !object.printed.holds(*row.other_order)) return;
  row.remark += "; the other word order is inside: is low_word_first wrong?";
  row.wrong = true;
}

}  // namespace

std::string address_text(const model::DriveModel& model, const model::ObjectDef& object) {
  return fmt::format("{} ({})", object.name, place_text(model, object));
}

std::vector<model::ObjectId> objects_to_read(const model::DriveModel& model) {
  std::vector<model::ObjectId> out;
  for (std::size_t id = 0; id < model.objects.size(); ++id) {
    const model::ObjectDef& object = model.objects[id];
    const bool own = !object.emulated && !object.composed && !object.is_directed();  // its two objects are read
    if (object.readable && own && !object.trigger) out.push_back(static_cast<model::ObjectId>(id));
  }
  return out;
}

ObjectRequest read_request(const model::DriveModel& model, model::ObjectId id) {
  const model::ObjectDef& object = model.object(id);
  ObjectRequest out{false, object.address.index, object.address.sub, object.size, 0};
  if (model::is_canopen(model)) {
    out.size = 0;  // as wide as the drive answers
    out.count = object.size;
  }
  return out;
}

ObjectRow row_of(const model::DriveModel& model, model::ObjectId id, const BatchResult& answer) {
  const model::ObjectDef& object = model.object(id);
  ObjectRow row{.name = object.name, .address = place_text(model, object), .type = type_text(object)};
  if (answer.outcome.code != Errc::ok) {
    const bool needed = model.needs(id);
    row.remark = refusal_text(answer) + (needed ? ": nothing moves without it" : "");
    row.wrong = needed;
    return row;
  }
  const bool has_width = model::is_canopen(model);
  if (has_width && answer.object_size != object.size) {
    const std::size_t bytes = answer.object_bytes ? answer.object_bytes->size() : answer.object_size;
    row.remark = fmt::format("{} bytes, the profile says {}", bytes, object.size);
    row.wrong = !object.any_width || bytes > object.size;
    if (row.wrong) return row;
    row.remark.clear();
  }
  if (object.is_real) {
    row.remark = fmt::format("{}", std::bit_cast<float>(answer.object_data));
    return row;
  }
  row.value = object.number(answer.object_data);
  if (has_two_words(model, object)) row.other_order = object.number(other_order(answer.object_data));
  judge_range(object, row);
  return row;
}

std::string line_of(const ObjectRow& row) {
  std::string out = fmt::format("{:<24} {:<14} {:<4}", row.name, row.address, row.type);
  if (row.value) out += fmt::format(" {}", *row.value);
  if (row.other_order && *row.other_order != *row.value) out += fmt::format(" (other word order {})", *row.other_order);
  if (!row.remark.empty()) out += fmt::format("{}{}{}", row.value ? ": " : " ", row.wrong ? "WRONG: " : "", row.remark);
  return out;
}

SetupRow setup_row(const model::DriveModel& model, const model::ObjectWrite& write, const BatchResult& answer) {
  const model::ObjectDef& object = model.object(write.object);
  const std::string name = address_text(model, object);
  if (answer.outcome.code != Errc::ok) return {fmt::format("{}: {}", name, refusal_text(answer)), false};
  const std::int64_t held = object.number(answer.object_data);
  const std::int64_t wanted = object.number(static_cast<std::uint32_t>(static_cast<std::uint64_t>(write.raw)));
  if (held == wanted) return {fmt::format("{} holds {}", name, held), true};
  return {fmt::format("{} holds {}, the setup writes {}", name, held, wanted), false};
}

}  // namespace axisgate::commands
