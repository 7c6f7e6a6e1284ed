// SPDX-License-Identifier: Apache-2.0
// What is known of each object of one drive: the number last read or acknowledged, and when its request was sent.
// Promises that a number counts as cached only while nothing has happened that could have changed it unseen
// (design 3.3), that objects at one place of the drive hold one number, that a part holds what its whole does, and a
// directed object what its magnitude and its direction do; that changed() grows with whatever becomes of an object.
// Never holds a value of a suspect drive: the drive does not put one in.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <vector>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

struct ObjectState {
  std::int64_t number = 0;
  bool known = false;          ///< read or acknowledged since bring-up
  bool cached = false;         ///< the drive is known to hold it now
  bool refused = false;        ///< the drive does not have it: not asked again until the next bring-up
  bool unlike = false;         ///< refused here: the drive has it in another width than its profile
  bool unresponsive = false;   ///< refused here: the drive may have it, and answers others
  bool unverified = false;     ///< acknowledged, but not read back yet
  bool unsure = false;         ///< a write of it may or may not have happened, and it was not read since
  bool out_of_sight = false;   ///< the drive was silent, or obeyed another master, since: it may hold anything
  bool clamped = false;        ///< read back other than it was acknowledged; until it is written again
  bool emulated = false;       ///< the gateway's own (virtual axis): nothing invalidates it
  Instant sent_at = kLongAgo;  ///< when the request that gave the number was sent
  std::uint64_t exchange = 0;  ///< and which one it was: tells before from after where both fall on one instant
};

class ObjectStore {
 public:
  explicit ObjectStore(std::size_t objects)
      : states_(objects),
        changed_(objects, changes_),
        periods_(objects),
        aliases_(objects),
        parts_(objects),
        wholes_(objects, model::kNoObject) {}
  /// Objects that are aliases of one another share what becomes of any of them, and parts what becomes of their whole.
  explicit ObjectStore(const std::vector<model::ObjectDef>& objects) : ObjectStore(objects.size()) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      aliases_[i] = objects[i].aliases;
      wholes_[i] = objects[i].part.whole;
      if (objects[i].is_directed())
        directed_.push_back({static_cast<model::ObjectId>(i), objects[i].part});
      else if (objects[i].is_part())
        parts_[wholes_[i]].push_back({static_cast<model::ObjectId>(i), objects[i]});
    }
  }

  [[nodiscard]] const ObjectState& operator[](model::ObjectId id) const {
    assert(id < states_.size());
    if (!directed_.empty()) direct(id);
    return states_[id];
  }
  /// Another number than before: something has become of the object since, a number or the time of one, or what
  /// period() says. Never 0.
  [[nodiscard]] std::uint64_t changed(model::ObjectId id) const {
    const model::PartOf* made_of = directed(id);
    return made_of == nullptr ? changed_[id] : std::max(changed_[made_of->whole], changed_[made_of->sign]);
  }
  /// The drive does not have it: it is neither silent about it, nor does it have it in another width.
  [[nodiscard]] bool is_absent(model::ObjectId id) const {
    const ObjectState& s = (*this)[id];
    return s.refused && !s.unresponsive && !s.unlike;
  }
  /// The drive's next exchange goes on the wire; what is read or acknowledged from now on comes from it. `changes`: it
  /// is no mere read.
  void begin_exchange(bool changes = false) {
    ++exchange_;
    if (changes) last_change_ = exchange_;
  }
  /// The newest exchange's number.
  [[nodiscard]] std::uint64_t exchange() const { return exchange_; }
  /// The number was asked for after the last thing that was sent to change anything: what was read before a stop went
  /// out shows neither that stop nor what was asked after it. Whoever finds something "so already" asks this.
  [[nodiscard]] bool shows_now(model::ObjectId id) const {
    const ObjectState& s = (*this)[id];
    return s.known && s.cached && s.exchange > last_change_;
  }

  void read(model::ObjectId id, std::int64_t number, Instant sent_at) {
    each(id, [&](ObjectState& s) {
      const bool clamped = s.unverified ? s.number != number : s.clamped && s.number == number;
      s = {.number = number,
           .known = true,
           .cached = true,
           .clamped = clamped,
           .sent_at = sent_at,
           .exchange = exchange_};
    });
    for (const Part& part : parts_[id]) read(part.id, part.number_in(number), sent_at);
  }
  /// It came by itself. The first one after the last sending may have been on its way before: it tells nothing of it.
  void received(model::ObjectId id, std::int64_t number, Instant at) {
    const bool first = (*this)[id].exchange < last_change_;
    read(id, number, at);
    if (first) whole(id, [this](ObjectState& s) { s.exchange = last_change_; });
  }
  void acknowledged(model::ObjectId id, std::int64_t number, Instant sent_at) {
    if (const model::PartOf* made_of = directed(id)) return acknowledged(made_of->whole, std::abs(number), sent_at);
    each(id, [&](ObjectState& s) {
      s = {.number = number,
           .known = true,
           .cached = true,
           .unverified = true,
           .sent_at = sent_at,
           .exchange = exchange_};
    });
    for (const Part& part : parts_[id]) acknowledged(part.id, part.number_in(number), sent_at);
    outlive(id);
  }
  /// Of a frame that carries the whole desired state: it was sent and may not have arrived, and what it asked for is
  /// what the next one asks for.
  void asked(model::ObjectId id, std::int64_t number, Instant sent_at) {
    each(id, [&](ObjectState& s) {
      s = {.number = number, .known = true, .unsure = true, .sent_at = sent_at, .exchange = s.exchange};
    });
  }
  /// The gateway's own number, made from samples of this exchange; kLongAgo and 0: from none.
  void make(model::ObjectId id, std::int64_t number, bool cached = true, Instant sent_at = kLongAgo,
            std::uint64_t exchange = 0) {
    at(id) = {
        .number = number, .known = true, .cached = cached, .emulated = true, .sent_at = sent_at, .exchange = exchange};
  }
  void refused(model::ObjectId id) { replace(id, {.refused = true}); }
  void unresponsive(model::ObjectId id) { replace(id, {.refused = true, .unresponsive = true}); }
  void unlike(model::ObjectId id) { replace(id, {.refused = true, .unlike = true}); }
  /// A write of it may or may not have happened.
  void invalidate(model::ObjectId id) {
    if (const model::PartOf* made_of = directed(id)) return invalidate(made_of->whole);
    whole(id, [](ObjectState& s) {
      s.cached = s.unverified = false;
      s.unsure = true;
    });
    outlive(id);
  }
  /// Nothing is taken as cached any more, but what `except` holds: timeout, mailbox write, mode change, fault reset,
  /// set_position (design 3.3).
  void invalidate_all(model::ObjectId except = model::kNoObject) {
    for (model::ObjectId id = 0; id < states_.size(); ++id)
      if (!same_place(id, except) && !states_[id].emulated) at(id).cached = at(id).unverified = false;
    ++invalidations_;
  }
  /// The same, after a timeout or another master's write.
  void lose_contact() {
    invalidate_all();
    for (model::ObjectId id = 0; id < states_.size(); ++id) at(id).out_of_sight = !states_[id].emulated;
  }
  /// How often invalidate_all() was called: whoever keeps the image true reads everything again then.
  [[nodiscard]] std::uint64_t invalidations() const { return invalidations_; }
  /// What it was last may be true, but nothing confirms it any more: good only when it is read again.
  void outdate(model::ObjectId id) {
    if (const model::PartOf* made_of = directed(id)) return outdate(made_of->whole);
    whole(id, [](ObjectState& s) { s.sent_at = kLongAgo; });
  }
  void forget(model::ObjectId id) { replace(id, {}); }
  /// How often the object is confirmed, where that is not its poll class's period; 0: it is.
  void set_period(model::ObjectId id, Duration period) {
    const auto set = [&](model::ObjectId each) {
      at(each);
      periods_[each] = period;
    };
    set(id);
    for (const Part& part : parts_[id]) set(part.id);
  }
  [[nodiscard]] Duration period(model::ObjectId id) const {
    const model::PartOf* made_of = directed(id);
    return periods_[made_of == nullptr ? id : made_of->whole];
  }
  /// Bring-up begins: nothing is known but what is the gateway's own.
  void forget_all() {
    for (model::ObjectId id = 0; id < states_.size(); ++id)
      if (!states_[id].emulated) at(id) = {};
  }

 private:
  /// Whatever becomes of an object becomes of it here.
  ObjectState& at(model::ObjectId id) {
    assert(id < states_.size());
    changed_[id] = ++changes_;
    return states_[id];
  }
  struct Part {
    model::ObjectId id = model::kNoObject;
    model::ObjectDef def;
    [[nodiscard]] std::int64_t number_in(std::int64_t whole) const {
      return def.number(static_cast<std::uint32_t>(whole) >> def.part.from);
    }
  };
  struct Directed {
    model::ObjectId id = model::kNoObject;
    model::PartOf made_of;
  };
  /// Null: it is no directed object.
  [[nodiscard]] const model::PartOf* directed(model::ObjectId id) const {
    const auto found = std::ranges::find(directed_, id, &Directed::id);
    return found == directed_.end() ? nullptr : &found->made_of;
  }
  /// Makes a directed object of what its two objects hold now. 0 has no direction; what says neither leaves it as is.
  void direct(model::ObjectId id) const {
    const model::PartOf* const found = directed(id);
    if (found == nullptr) return;
    const model::PartOf& made_of = *found;
    const ObjectState& way = states_[made_of.sign];
    const bool was_negative = states_[id].number < 0;
    ObjectState out = states_[made_of.whole];
    out.refused = out.refused || way.refused;
    if (out.number != 0) {
      if (way.number == made_of.negative || (way.number != made_of.positive && was_negative)) out.number = -out.number;
      out.known = out.known && way.known;
      out.cached = out.cached && way.cached;
      out.unsure = out.unsure || way.unsure;
      out.out_of_sight = out.out_of_sight || way.out_of_sight;
      if (way.exchange < out.exchange) {
        out.exchange = way.exchange;
        out.sent_at = way.sent_at;
      }
    }
    states_[id] = out;
  }
  template <typename Change>
  void each(model::ObjectId id, Change change) {
    change(at(id));
    for (const model::ObjectId alias : aliases_[id]) change(at(alias));
  }
  /// With its parts.
  template <typename Change>
  void whole(model::ObjectId id, Change change) {
    each(id, change);
    for (const Part& part : parts_[id]) each(part.id, change);
  }
  void replace(model::ObjectId id, const ObjectState& state) {
    at(id) = state;
    for (const Part& part : parts_[id]) at(part.id) = state;
  }
  /// A part was written: what its whole was read as is no more.
  void outlive(model::ObjectId id) {
    if (wholes_[id] != model::kNoObject) at(wholes_[id]).cached = false;
  }
  [[nodiscard]] bool same_place(std::size_t id, model::ObjectId other) const {
    if (other == model::kNoObject) return false;
    const auto& aliases = aliases_[other];
    return id == other || std::ranges::find(aliases, id) != aliases.end();
  }
  mutable std::vector<ObjectState> states_;  ///< that of a directed object is made whenever somebody looks
  std::uint64_t changes_ = 1;
  std::vector<std::uint64_t> changed_;  ///< of each object, what changes_ was then
  std::vector<Duration> periods_;
  std::vector<std::vector<model::ObjectId>> aliases_;
  std::vector<std::vector<Part>> parts_;  ///< of each whole
  std::vector<model::ObjectId> wholes_;   ///< of each part
  std::vector<Directed> directed_{};
  std::uint64_t exchange_ = 0;
  std::uint64_t last_change_ = 0;  ///< the newest exchange that was no mere read
  std::uint64_t invalidations_ = 0;
};

}  // namespace axisgate::drive
