// SPDX-License-Identifier: Apache-2.0
// Who owns one axis, and until when (design 3.5). Pure: requests and instants in, verdicts out.
// Promises at most one owner; that nobody is refused where leases are off; that a lease runs out at the instant its
// rules say, and its end is reported exactly once. Never stops an axis: the axis does what its lease's action says.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gateway/core/error.hpp"
#include "gateway/image/lease.hpp"

namespace axisgate::drive {

class Ownership {
 public:
  using ClientPtr = std::shared_ptr<const ClientLife>;

  /// `lease` is what the image shows; it is kept up to date by this.
  Ownership(Lease& lease, const LeaseRules& rules) : lease_(lease) { lease_.rules = rules; }

  /// Whether what this client asks may be carried out: ok, or not_owner. `claims`: a write that would make it the
  /// owner, and so may take over a weaker DDS writer's lease. What its own connection of before has left hinders
  /// nobody. No client: the gateway itself, which is always admitted.
  [[nodiscard]] Errc judge(const ClientPtr& client, bool claims) const;

  /// How a client became the owner.
  enum class Taken : std::uint8_t {
    nothing,               ///< it was the owner already, or leases are off
    free,                  ///< nobody owned the axis
    open,                  ///< of an axis that was enabled without an owner
    orphan,                ///< of its own address, whose connection had ended, and which it may be the return of
    same_origin_and_role,  ///< of its own address, by command take_over
    weaker,                ///< of a DDS writer of less strength
    lower_rank,            ///< by command take_over
  };
  /// After judge() has admitted its claim. The lease runs from the beginning from now.
  Taken take(const ClientPtr& client, Instant now);
  /// A write of any kind takes this lease over: an orphan of the client's own origin and role, or, unless it is nothing
  /// but zeros, that of an axis which was found enabled.
  [[nodiscard]] bool waits_for(const ClientPtr& client, bool all_zero) const;
  /// A write of this client to the axis. `beats`: register 56 has changed; `asks`: it asks for something. Others'
  /// writes renew nothing, and while the axis is disabled only what asks does.
  void wrote(const ClientPtr& client, bool beats, bool asks, Instant now);
  /// Whether the axis may hold torque, or nobody knows: all signs of life of the owner count then.
  void set_armed(bool armed);

  /// Command take_over: ok where nobody owns the axis, this client does, another connection of the same address and
  /// role, or a client of a lower rank.
  [[nodiscard]] Errc may_take_over(const ClientPtr& client) const;
  /// Command release: ok for the owner, and where nobody owns the axis. `enabled`: the lease stays open to others.
  [[nodiscard]] Errc release(const ClientPtr& client, bool enabled, Instant now);
  /// The axis is enabled and nobody owns it: open to every operator until the lease runs out.
  void open(Instant now);

  /// The lease has just run out: nobody owns the axis any more. Call it in each turn that `until()` names.
  struct Expired {
    bool was_open = false;  ///< nobody owned it
    ClientPtr owner{};
    Duration timeout{};  ///< how long its owner was silent
  };
  [[nodiscard]] std::optional<Expired> take_expired(Instant now);
  /// Somebody answers for the axis now: leases are off, or the lease runs.
  [[nodiscard]] bool live(Instant now) const { return !lease_.rules.on || (lease_.running && now < lease_.until()); }
  [[nodiscard]] Instant until() const { return lease_.until(); }
  [[nodiscard]] bool is_owner(ClientId client) const { return lease_.owned_by(client); }
  [[nodiscard]] const ClientPtr& owner() const { return lease_.owner; }
  [[nodiscard]] const LeaseRules& rules() const { return lease_.rules; }

 private:
  [[nodiscard]] Taken how(const ClientLife& client) const;

  Lease& lease_;
  bool adopted_ = false;  ///< the open lease is of an axis that was found enabled, and not of one that was released
};

/// For the event of it.
[[nodiscard]] std::string text(Ownership::Taken taken, const ClientLife& client);

}  // namespace axisgate::drive
