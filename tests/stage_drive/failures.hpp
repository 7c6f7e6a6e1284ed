// SPDX-License-Identifier: Apache-2.0
// How one exchange can fail, and what its command sequence may come to then.
// Promises that only the exchange that is on the wire now is hit.
#pragma once

#include <array>

#include "gateway/core/error.hpp"
#include "tests/simulated/drive_faults.hpp"

namespace axisgate::test {

enum class Failure : std::uint8_t {
  muted,
  reply_lost,
  reply_late,
  reply_twice,
  refused,
  cut_before,
  cut_after,
  restarted
};
[[nodiscard]] inline const char* text_of(Failure failure) {
  static constexpr std::array kNames{"muted",   "reply_lost", "reply_late", "reply_twice",
                                     "refused", "cut_before", "cut_after",  "restarted"};
  return kNames[static_cast<std::size_t>(failure)];
}

/// Called when the link is given the request.
template <class Link>
void fail_now(Link& link, simulated::DriveFaults& faults, Failure failure) {
  using simulated::DriveFault;
  switch (failure) {
    case Failure::muted:
      return faults.next(DriveFault::unresponsive);
    case Failure::reply_lost:
      return faults.next(DriveFault::lose);
    case Failure::reply_late:
      faults.late_by = std::chrono::milliseconds(150);
      return faults.next(DriveFault::late);
    case Failure::reply_twice:
      return faults.next(DriveFault::duplicate);
    case Failure::restarted:
      return faults.next(DriveFault::restart);
    case Failure::refused:
      link.fate = Link::Fate::refused;
      return;
    case Failure::cut_before:
      link.fate = Link::Fate::cut_before;
      return;
    case Failure::cut_after:
      link.fate = Link::Fate::cut_after;
      return;
  }
}

/// `asks_again`: what was refused is asked again until its time is up.
[[nodiscard]] inline bool allowed(Failure failure, Errc code, bool asks_again) {
  switch (failure) {
    case Failure::muted:
    case Failure::reply_lost:
    case Failure::reply_late:
      // Read back, or the write did not happen, or it was the mailbox's own, which nobody can read back for it.
      return code == Errc::ok || code == Errc::timed_out;
    case Failure::reply_twice:
      return code == Errc::ok;
    case Failure::refused:
      return code == Errc::ok || code == Errc::refused_by_drive || (asks_again && code == Errc::timed_out);
    case Failure::cut_before:
    case Failure::cut_after:
      // Done: it was the poll behind the last exchange that was cut. Offline: it was the poll before the first.
      return code == Errc::ok || code == Errc::link_lost || code == Errc::offline;
    case Failure::restarted:
      // A drive that comes back as nothing it was asked to be; 0x04 where a state check came first.
      return code == Errc::ok || code == Errc::link_lost || code == Errc::offline || code == Errc::timed_out ||
             code == Errc::not_reached || code == Errc::state_unsuitable;
  }
  return false;
}

}  // namespace axisgate::test
