// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/read_blocks.hpp"

#include <algorithm>
#include <array>

namespace axisgate::drive {
namespace {

int last_register(const model::ObjectDef& object) { return object.address.index + (object.size > 2 ? 1 : 0); }

bool same_query(const model::ObjectDef& a, const model::ObjectDef& b) {
  return a.address.index == b.address.index && a.address.sub == b.address.sub;
}

}  // namespace

std::vector<PlannedRead> planned_reads(const model::DriveModel& model) {
  const ReadBlocks blocks(model);
  const std::vector<PollItem> items = poll_items(model);
  std::vector<PlannedRead> out;
  for (const PollItem& item : items) {
    const model::ObjectDef& object = model.object(item.object);
    bus::Exchange exchange{model.node, bus::Access::read, object.address, object.size, 0};
    blocks.widen(exchange, [](model::ObjectId) { return true; });
    const auto same = std::ranges::find_if(
        out, [&](const PlannedRead& read) { return !exchange.more.empty() && read.exchange == exchange; });
    if (same == out.end())
      out.push_back({item.poll_class, exchange});
    else
      same->poll_class = std::min(same->poll_class, item.poll_class);
  }
  return out;
}

ReadBlocks::ReadBlocks(const model::DriveModel& model) : model_(model) {
  const std::vector<PollItem> items = poll_items(model);
  constexpr std::array kClasses{model::PollClass::fast, model::PollClass::normal, model::PollClass::slow,
                                model::PollClass::once};
  for (const auto& [first, last] : model.rtu.runs) {
    for (const model::PollClass poll_class : kClasses) {
      std::vector<model::ObjectId> neighbours;
      for (const PollItem& item : items) {
        const model::ObjectDef& object = model.object(item.object);
        const bool holding = !object.emulated && object.address.sub == 0;  // the runs are of this table
        const bool inside = holding && object.address.index >= first && last_register(object) <= last;
        if (item.poll_class == poll_class && inside) neighbours.push_back(item.object);
      }
      pack(neighbours);
    }
  }
  group_answers();
}

// All that the model has of an answer, whatever is polled of it.
void ReadBlocks::group_answers() {
  const auto& objects = model_.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto has = [&](const Block& b) { return same_query(model_.object(b.objects.front()), objects[i]); };
    const bool grouped = std::ranges::any_of(blocks_, [&](const Block& b) { return b.one_answer && has(b); });
    if (objects[i].emulated || objects[i].is_part() || !objects[i].readable || grouped) continue;
    Block block{{}, 0, true};
    for (std::size_t k = i; k < objects.size() && block.objects.size() < bus::kMaxReplyFields; ++k) {
      const bool there = std::ranges::any_of(block.objects, [&](model::ObjectId id) {
        return model_.object(id).address == objects[k].address;  // an alias comes with the other
      });
      if (!objects[k].emulated && !objects[k].is_part() && objects[k].readable && same_query(objects[i], objects[k]) &&
          !there)
        block.objects.push_back(static_cast<model::ObjectId>(k));
    }
    if (block.objects.size() < 2) continue;
    std::ranges::sort(block.objects, {}, [&](auto id) { return model_.object(id).address; });
    blocks_.push_back(std::move(block));
  }
}

void ReadBlocks::pack(const std::vector<model::ObjectId>& neighbours) {
  std::vector<model::ObjectId> sorted = neighbours;
  std::ranges::sort(sorted, {}, [&](auto id) { return model_.object(id).address; });
  Block block;
  const auto close = [&] {
    if (block.objects.size() > 1) blocks_.push_back(block);
    block = {};
  };
  for (const model::ObjectId id : sorted) {
    if (!block.objects.empty()) {
      // An alias comes with the other.
      if (model_.object(block.objects.back()).address == model_.object(id).address) continue;
      const int first = model_.object(block.objects.front()).address.index;
      const bool fits = last_register(model_.object(id)) - first + 1 <= model_.rtu.max_registers;
      if (!fits || block.objects.size() == bus::kMaxReplyFields) close();
    }
    block.objects.push_back(id);
  }
  close();
}

std::size_t ReadBlocks::block_of(const bus::Exchange& exchange) const {
  if (exchange.access != bus::Access::read) return kNone;
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    for (const model::ObjectId id : blocks_[i].objects) {
      const model::ObjectDef& object = model_.object(id);
      if (object.address == exchange.object && object.size == exchange.size) return i;
    }
  return kNone;
}

void ReadBlocks::add(bus::Exchange& exchange, model::ObjectId id) const {
  const model::ObjectDef& object = model_.object(id);
  if (exchange.size == 0) {
    exchange.object = object.address;
    exchange.size = object.size;
  } else {
    exchange.more.push_back({object.address, object.size});
  }
}

bool ReadBlocks::refused(const bus::Exchange& exchange) {
  if (exchange.more.empty() || one_answer(exchange)) return false;
  const std::size_t at = block_of(exchange);
  if (at == kNone) return true;  // it fell in two while this was on the wire
  const ObjectAddress middle = exchange.more[exchange.more.size() / 2].object;
  auto& objects = blocks_[at].objects;
  const auto cut = std::ranges::find_if(objects, [&](auto id) { return model_.object(id).address >= middle; });
  Block upper{{cut, objects.end()}, 0, false};
  objects.erase(cut, objects.end());
  blocks_[at].silences = 0;
  blocks_.push_back(std::move(upper));
  return true;
}

bool ReadBlocks::silent(const bus::Exchange& exchange) {
  if (exchange.more.empty()) return false;
  const std::size_t at = block_of(exchange);
  if (at == kNone || ++blocks_[at].silences < kSilences) return false;
  return refused(exchange);
}

void ReadBlocks::answered(const bus::Exchange& exchange) {
  if (exchange.more.empty()) return;
  const std::size_t at = block_of(exchange);
  if (at != kNone) blocks_[at].silences = 0;
}

}  // namespace axisgate::drive
