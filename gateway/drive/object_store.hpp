// What is known of each object of one drive: the number last read or acknowledged, and when its request was sent.
// Promises that a number counts as held only while nothing has happened that could have changed it unseen (design 3.3).
// Never holds a value of a suspect drive: the drive does not put one in.
#pragma once

#include <cassert>
#include <vector>

#include "gateway/drive/model.hpp"

namespace axisgate::drive {

struct ObjectState {
  std::int64_t number = 0;
  bool known = false;       ///< read or acknowledged since bring-up
  bool held = false;        ///< the drive is known to hold it now
  bool refused = false;     ///< the drive does not have it: not asked again until the next bring-up
  bool unverified = false;  ///< acknowledged, but not read back yet
  Instant sent_at = kLongAgo;  ///< when the request that gave the number was sent
  std::uint64_t exchange = 0;  ///< and which one it was: tells before from after where both fall on one instant
};

class ObjectStore {
 public:
  explicit ObjectStore(std::size_t objects) : states_(objects) {}

  [[nodiscard]] const ObjectState& operator[](ObjectId id) const {
    assert(id < states_.size());
    return states_[id];
  }
  /// The drive's next exchange goes on the wire; what is read or acknowledged from now on comes from it.
  void begin_exchange() { ++exchange_; }
  /// The newest exchange's number.
  [[nodiscard]] std::uint64_t exchange() const { return exchange_; }

  /// A number read. Returns true where a value acknowledged before reads back differently: the drive has clamped it.
  bool read(ObjectId id, std::int64_t number, Instant sent_at) {
    ObjectState& s = at(id);
    const bool clamped = s.unverified && s.number != number;
    s = {number, true, true, false, false, sent_at, exchange_};
    return clamped;
  }
  void acknowledged(ObjectId id, std::int64_t number, Instant sent_at) {
    at(id) = {number, true, true, false, true, sent_at, exchange_};
  }
  void refused(ObjectId id) {
    at(id) = {};
    at(id).refused = true;
  }
  /// A write of it may or may not have happened.
  void doubt(ObjectId id) { at(id).held = at(id).unverified = false; }
  /// Nothing is taken as held any more: timeout, mailbox write, mode change, fault reset, set_position (design 3.3).
  void doubt_all() {
    for (ObjectState& s : states_) s.held = s.unverified = false;
  }
  /// Bring-up begins: nothing is known.
  void forget_all() { states_.assign(states_.size(), ObjectState{}); }

 private:
  ObjectState& at(ObjectId id) {
    assert(id < states_.size());
    return states_[id];
  }
  std::vector<ObjectState> states_;
  std::uint64_t exchange_ = 0;
};

}  // namespace axisgate::drive
