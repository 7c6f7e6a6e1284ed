// SPDX-License-Identifier: Apache-2.0
// What a drive is read for by the gateway itself, and what becomes of the answers (design 7, points 4 and 6): the poll
// plan, what is read along in one request, the resynchronisation read after a timeout, what is asked in vain, and what
// comes unsolicited. Pure: exchanges, results and instants go in. Promises that no answer counts while a late one could
// pass for it, that what the drive does not have is not asked again before the next bring-up, that one object which
// does not answer, or is refused for now, costs the others nothing, and that a number of another width than the
// profile's is shown nowhere. Never sends, and never judges whether the drive is there.
#pragma once

#include <string>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/device/object_tries.hpp"
#include "gateway/drive/device/read_blocks.hpp"
#include "gateway/drive/device/resync.hpp"
#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

class DriveReads {
 public:
  /// How the exchange on the wire was asked for, as far as its answer is judged by it.
  struct Asked {
    bool resync = false;
    bool probe = false;
    bool counted = false;  ///< it counts lost replies out: its answer may be one of them
    bool widened = false;  ///< it reads neighbours that nobody asked for
    Instant sent_at = kLongAgo;
  };
  /// Who has asked for a read.
  enum class For : std::uint8_t { poll, bring_up, other };

  /// `model`: constants that are read from the drive change its scales and limits.
  DriveReads(model::DriveModel& model, ObjectStore& store);

  // --- What is read next ---------------------------------------------------------------------------------------------

  /// The drive comes up from scratch: nothing is known of it, all is due, and nothing is owed.
  void restart(Instant now);
  [[nodiscard]] std::optional<bus::Exchange> poll(Instant now) const;
  [[nodiscard]] Instant poll_due() const { return plan_.next_due(); }
  /// What comes along in the same request at little cost: in bring-up all that is not known yet, in a poll all that is
  /// due as well, and of the state never a part without the rest.
  void widen(bus::Exchange& exchange, Asked& asked, For whom, Instant now) const;
  /// It is read as soon as its turn comes.
  void hurry(model::ObjectId object, Instant now) { plan_.hurry(model_.whole(object), now); }
  void hurry_state(const model::AxisModel& axis, Instant now);
  /// It is read next, before all that is overdue.
  void first(model::ObjectId object) { plan_.hurry(model_.whole(object), kLongAgo); }
  /// A write of it was acknowledged.
  void written(model::ObjectId object, Instant now) { plan_.written(model_.whole(object), now); }
  /// What was invalidated since the last call is read again.
  void refresh(Instant now);
  /// Bytes of an object, as the drive answered last.
  [[nodiscard]] std::uint8_t width(model::ObjectId object) const { return width_[object]; }
  /// Some axis's statusword is made from it, or is it.
  [[nodiscard]] bool tells_state(model::ObjectId object) const { return tells_state_[model_.whole(object)]; }
  /// Objects that were given up since the last call.
  [[nodiscard]] std::vector<ObjectTries::GivenUp> take_given_up() { return tries_.take_given_up(); }
  [[nodiscard]] const ObjectTries& tries() const { return tries_; }
  /// The bring-up that was begun is for its sake.
  void keep_given_up(model::ObjectId object, Instant now) { tries_.keep_given_up(object, now); }
  /// So it was known that nobody answers this read: that says nothing of the drive.
  [[nodiscard]] bool expects_silence(const bus::Exchange& exchange) const;

  // --- Late replies --------------------------------------------------------------------------------------------------

  /// It owes a reply: no answer counts but that to a resynchronisation read or a probe.
  [[nodiscard]] bool suspect() const { return resync_.suspect(); }
  [[nodiscard]] bool counts(const Asked& asked) const { return !suspect() || asked.resync || asked.probe; }
  /// When the next resynchronisation read, or what takes its place, may go.
  [[nodiscard]] Instant resync_due(Instant now) const {
    return resync_.exhausted() || !resync_.candidate() ? resync_.silent_until() : now;
  }
  /// From then on every reply that is still owed would come too late by the profile.
  [[nodiscard]] Instant silent_until() const { return resync_.silent_until(); }
  /// None: silence must be kept until silent_until().
  [[nodiscard]] std::optional<bus::Exchange> resync(Asked& asked, Instant now);
  /// A drive that is not there is looked for: false while a reply to something lost long ago could still come.
  [[nodiscard]] bool may_probe(Instant now);
  [[nodiscard]] bus::Exchange probe(Asked& asked);

  // --- What comes back -----------------------------------------------------------------------------------------------

  /// This exchange was not answered in time: what the drive holds is not known any more.
  void timed_out(const bus::Exchange& exchange, const Asked& asked, Instant now);
  /// The line was lost: the reply may still come after its return.
  void lost(const bus::Exchange& exchange, Instant now) { resync_.lost(exchange, now); }
  /// The drive has answered. True: that proves that nothing is owed.
  bool answered(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked, Instant now);
  struct Taken {
    bool samples = false;  ///< there are new ones
    bool back = false;     ///< an object that was given up has answered
    bool scales = false;   ///< a constant of the drive was read: scales and limits have changed
    std::vector<std::string>
        unlike{};  ///< objects of another width than the profile says, taken or not, to be reported
  };
  /// Of an answer that counts: what it tells goes into the store.
  [[nodiscard]] Taken take(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked,
                           Instant now);
  /// A read of several objects that was refused: true where it is tried again in smaller parts.
  [[nodiscard]] bool split(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked);

  struct Settled {
    bool scales = false;               ///< they have changed
    std::vector<std::string> unknown;  ///< constants that the drive does not tell, to be reported: each once
  };
  /// All was read that bring-up reads: a constant has the value that the drive tells now, and no earlier one's.
  [[nodiscard]] Settled settle();

  // --- Unsolicited values --------------------------------------------------------------------------------------------

  /// It comes by TPDO from now on; `event`: its timer.
  void map(model::ObjectId object, std::optional<Duration> event);
  /// Nothing does any more.
  void unmap(Instant now);
  /// What came by TPDO so far is no sample of the drive as it is now.
  void outdate_mapped();
  void take_unsolicited(const bus::ReplyFields& fields, Instant now);
  /// The position of this axis must not hang on a TPDO that has failed to come while it moves.
  void watch_position(const model::AxisModel& axis, bool moves, Instant now);

 private:
  /// A position that comes by TPDO is read after so long without one while its axis moves.
  static constexpr Duration kMovingConfirm = std::chrono::milliseconds(250);

  /// After the silence, of a drive whose replies are distinguished still. `trusted`: what its answer then is.
  [[nodiscard]] bus::Exchange after_silence(Asked& asked, bool Asked::*trusted);
  void take_field(const bus::Exchange& exchange, const bus::ReplyField& field, const Asked& asked, Taken& taken,
                  Instant now);
  void take_refusal(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked, Instant now);
  /// Without it there is no axis: it is asked for ever.
  [[nodiscard]] bool needed(model::ObjectId object) const;
  void in_vain(model::ObjectId object, const ObjectTries::Refusal& refusal, Instant now);
  /// The drive lives, and did not answer this read.
  void was_silent(Instant now);
  [[nodiscard]] bool read_constants();
  [[nodiscard]] model::Evaluated evaluated(const model::DriveConstant& constant) const;
  void rescale();

  model::DriveModel& model_;
  ObjectStore& store_;
  PollPlan plan_;
  Resync resync_;
  ReadBlocks blocks_;
  ObjectTries tries_;
  /// A read that was not answered; whether the drive lives is not known yet.
  struct Silent {
    bus::Exchange exchange;
    Asked asked;
  };
  std::optional<Silent> silent_{};
  /// The drive has answered a read since it came up: what it refuses from now on it may not have.
  bool answers_ = false;
  std::size_t probes_ = 0;  ///< of a drive that owes nothing
  std::vector<std::optional<Rational>> constants_;
  std::vector<std::string> unknown_;  ///< why each of them is, as it was reported last
  std::vector<std::uint8_t> width_;
  bool wide_reported_ = false;  ///< since bring-up: that it answers more bytes than an object has
  std::vector<bool> mapped_;    ///< objects that come by TPDO
  std::vector<bool> tells_state_;
  std::uint64_t invalidations_seen_ = 0;
};

}  // namespace axisgate::drive
