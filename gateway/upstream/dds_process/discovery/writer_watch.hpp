// SPDX-License-Identifier: Apache-2.0
// The DataWriters of the command topics, as the DDS library's threads tell of them: who is there, how strong, alive or
// not. Promises that each appearance and each loss is reported once, in their order for one writer, and that no more
// than kMaxWritersKnown are known at a time. Never knows a DDS type or a clock; locks for as long as a look at its
// table takes.
#pragma once

#include <compare>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// What beats() may say at once.
inline constexpr std::size_t kMostBeatRecords = kMaxWritersKnown / kMaxBeats;
/// What a writer with a lease gets beside it when it appears: until its assertions are heard.
inline constexpr SteadyNs kFirstGrace = 1'000'000'000;

/// The topics that are read, axis_command once for each kind of ownership: a reader of one hears no writer of the
/// other.
enum class CommandTopic : std::uint8_t { command, shared_command, object };

/// What a writer states of its liveliness, where that is a sign of life. Those of one length are heard by one reader.
struct LivelinessLease {
  CommandTopic topic = CommandTopic::command;
  SteadyNs length = 0;  ///< 0: none that counts
  friend auto operator<=>(const LivelinessLease&, const LivelinessLease&) = default;
};

/// What a writer states of itself when it is discovered.
struct WriterStatement {
  std::int32_t strength = 0;
  LivelinessKind kind = LivelinessKind::endless;
  LivelinessLease lease{};
  std::string where{};
  friend bool operator==(const WriterStatement&, const WriterStatement&) = default;
};

class WriterWatch {
 public:
  // From any thread. Each may make changes to be taken.
  void on_discovered(const Guid& writer, const WriterStatement& statement);
  void on_matched(const Guid& writer, SteadyNs now);
  void on_unmatched(const Guid& writer);
  /// Removed by its participant, or that is gone.
  void on_removed(const Guid& writer);
  /// By a reader that asks for this lease. Of writers with another one it says nothing.
  void on_liveliness(const Guid& writer, const LivelinessLease& asked, bool alive);
  /// A sample of it was received, which is an assertion of its liveliness.
  void on_sample(const Guid& writer, SteadyNs now);

  struct Changes {
    std::vector<WriterRecord> before{};  ///< to be reported before the samples that were taken
    std::vector<WriterRecord> after{};   ///< losses: after them
    std::size_t refused = 0;             ///< writers not taken in since the last call, for want of room
  };
  [[nodiscard]] Changes take_changes(SteadyNs now);
  /// Of all those with a lease that is good now: one record at least, which may be empty.
  [[nodiscard]] std::vector<BeatRecord> beats(SteadyNs now) const;
  /// All that count, of writers that are matched: one that met the reader of its lease first would write its first
  /// command to that one alone.
  [[nodiscard]] std::set<LivelinessLease> leases() const;

 private:
  struct Writer {
    WriterStatement statement{};
    bool discovered = false;  ///< and so its statement known: another participant of ours matches it
    bool matched = false;
    bool asserted = false;    ///< since it was matched: that it was found is no sign of life
    bool heard = false;       ///< by the reader of its lease: alive
    SteadyNs good_until = 0;  ///< by our own reckoning, where it is not heard
    bool lost_since = false;  ///< also if it came back
    bool reported = false;    ///< as there
    WriterStatement reported_statement{};
    [[nodiscard]] bool there(SteadyNs now) const {
      return discovered && matched && (statement.lease.length == 0 || heard || now < good_until);
    }
  };
  Writer* find(const Guid& writer);
  Writer* find_or_add(const Guid& writer);

  mutable std::mutex mutex_;
  std::map<Guid, Writer> writers_;
  std::size_t refused_ = 0;
};

}  // namespace axisgate::dds
