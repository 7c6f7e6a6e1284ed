// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/bring_up.hpp"

#include <algorithm>

#include "gateway/drive/device/word_order.hpp"
#include "gateway/model/cia402.hpp"

namespace axisgate::drive {

BringUp::BringUp(const model::DriveModel& model, Duration timeout)
    : model_(model), identity_(model), node_(model), start_(timeout) {
  const auto add = [&](model::ObjectId id) {
    if (id != model::kNoObject && std::ranges::find(reads_, id) == reads_.end()) reads_.push_back(id);
  };
  for (const model::AxisModel& axis : model.axes)
    for (const model::ObjectId id : axis.state_sources) add(id);  // the state comes before everything
  for (const model::ObjectWrite& setup : model.setup)
    if (model.object(setup.object).readable) add(setup.object);
  for (const model::FactoryWrite& setup : model.factory_writes) add(setup.object);
  // What changes fastest is read last: the drive goes online with values that are still good.
  std::vector<PollItem> items = poll_items(model);
  std::ranges::stable_sort(items, std::greater(), &PollItem::poll_class);
  for (const PollItem& item : items) {
    add(item.object);
    if (item.poll_class == model::PollClass::fast) confirmed_.push_back(item.object);
  }
}

void BringUp::begin() {
  read_at_ = setup_at_ = 0;
  setup_written_ = read_back_ = adopted_ = completed_ = false;
  exchange_tries_ = write_tries_ = 0;
  write_again_ = kLongAgo;
  refused_for_now_.clear();
  amend_pause_ = {};
  amend_due_ = kNever;
  amending_ = false;
  confirm_after_.reset();
  unheld_.clear();
  setup_.reset();
  identity_.begin();
  node_.begin();
  start_.begin();
}

bool BringUp::any_enabled(const ObjectStore& store) const {
  return std::ranges::any_of(model_.axes, [&](const model::AxisModel& axis) {
    const ObjectState& s = store[axis.statusword];
    return s.known && model::holds_motor(model::state_of(static_cast<std::uint16_t>(s.number)));
  });
}

std::optional<BringUp::Next> BringUp::next(const ObjectStore& store) {
  if (amending_) return any_enabled(store) ? std::nullopt : next_setup(store);
  while (read_at_ < reads_.size()) {
    const ObjectState& s = store[reads_[read_at_]];
    // The state is asked for ever: without it there is no axis. What else is asked in vain counts as refused.
    if (!s.known && (!s.refused || model_.needs_for_state(reads_[read_at_]))) return Next{reads_[read_at_], false, 0};
    ++read_at_;
  }
  if (is_node())
    if (const auto identity = identity_.next()) return Next{model::kNoObject, false, 0, identity};
  // Everything else was read meanwhile: somebody may have enabled it since its state was read, and on a busy line what
  // was read first has grown stale.
  if (!confirm_after_) confirm_after_ = store.exchange();
  for (const model::ObjectId id : confirmed_)
    if (!store[id].refused && store[id].exchange <= *confirm_after_) return Next{id, false, 0};
  adopted_ = any_enabled(store);
  if (adopted_ || !identity_.mismatch().empty() || lacks_needed(store)) return std::nullopt;
  if (const auto setup = next_setup(store)) return setup;
  if (is_node())
    if (const auto node = node_.next()) return Next{model::kNoObject, false, 0, node};
  return std::nullopt;
}

// It is not what its profile says: nothing of that profile is written to it.
bool BringUp::lacks_needed(const ObjectStore& store) const {
  if (!against_word_order(model_, store).empty()) return true;
  for (std::size_t i = 0; i < model_.objects.size(); ++i)
    if (const auto id = static_cast<model::ObjectId>(i); store[id].refused && model_.needs(id)) return true;
  return false;
}

std::vector<model::ObjectWrite> BringUp::setup_due(const ObjectStore& store) const {
  return model::setup_writes(
      model_, [&](model::ObjectId id) { return store[id].known ? std::optional(store[id].number) : std::nullopt; },
      [&](model::ObjectId id) { return store.is_absent(id); });
}

std::optional<BringUp::Next> BringUp::next_setup(const ObjectStore& store) {
  // Judged once: what is written here must not make its own reason go away.
  if (!setup_) setup_ = setup_due(store);
  while (setup_at_ < setup_->size()) {
    const model::ObjectWrite& setup = (*setup_)[setup_at_];
    if (read_back_ && !store[setup.object].refused) return Next{setup.object, false, 0};
    read_back_ = false;
    const bool holds = store[setup.object].known && store[setup.object].number == setup.raw;
    if (holds || setup_written_) {
      if (!holds && model_.object(setup.object).readable) unheld_.push_back(setup.object);
      ++setup_at_;
      setup_written_ = false;
      write_tries_ = 0;
      continue;
    }
    return Next{setup.object, true, setup.raw};
  }
  return std::nullopt;
}

void BringUp::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result, const ObjectStore& store,
                        Instant now) {
  const bool refused = result.code == Errc::refused_by_drive;
  if (const auto given = next(store); given && given->exchange) {
    // Lost: asked once more, when the resynchronisation read is answered; but not for ever.
    const bool lost = result.code == Errc::timed_out || result.code == Errc::bad_reply;
    if (*given->exchange != exchange || !(refused || result.code == Errc::ok || lost)) return;
    if (lost && ++exchange_tries_ < ObjectTries::kTries) return;
    exchange_tries_ = 0;
    identity_.next() ? identity_.on_result(result) : node_.on_result(result);
  } else if (exchange.access == bus::Access::write) {
    refused ? write_refused(result.for_now, now) : written();
  } else if (result.code == Errc::ok) {
    read_back_ = false;
  }
}

void BringUp::written() {
  setup_written_ = true;
  read_back_ = setup_ && setup_at_ < setup_->size() && model_.object((*setup_)[setup_at_].object).readable;
}

void BringUp::write_refused(bool for_now, Instant now) {
  read_back_ = false;
  const int tries = amending_ ? 1 : ObjectTries::kTries;
  if (for_now && ++write_tries_ < tries) {
    write_again_ = now + write_tries_ * ObjectTries::kFirstPause;
    return;
  }
  setup_written_ = true;
  if (!for_now || !setup_ || setup_at_ >= setup_->size()) return;
  refused_for_now_.push_back((*setup_)[setup_at_]);
  amend_due_ = now + std::max(amend_pause_, ObjectTries::kFirstPause);
}

// What a client has written meanwhile stays.
void BringUp::begin_amending(const ObjectStore& store, Instant now) {
  amending_ = true;
  amend_pause_ = std::clamp(2 * amend_pause_, ObjectTries::kFirstPause, ObjectTries::kLongestPause);
  amend_due_ = kNever;
  read_back_ = setup_written_ = false;
  setup_ = std::exchange(refused_for_now_, {});
  std::erase_if(*setup_, [due = setup_due(store)](const model::ObjectWrite& refused) {
    return std::ranges::none_of(due, [&](const model::ObjectWrite& each) { return each.object == refused.object; });
  });
  setup_at_ = 0;
  write_again_ = now;
  unheld_.clear();
}

void BringUp::end_amending(Instant now) {
  if (!std::exchange(amending_, false)) return;
  refused_for_now_.insert(refused_for_now_.end(), setup_->begin() + static_cast<std::ptrdiff_t>(setup_at_),
                          setup_->end());
  if (!refused_for_now_.empty()) amend_due_ = now + amend_pause_;
}

}  // namespace axisgate::drive
