// The DataWriters of the command topics, as the DDS library's threads tell of them: who is there, how strong, alive or
// not. Promises that each appearance and each loss is told once, in their order for one writer, and that no more than
// kMaxWritersKnown are known at a time. Never knows a DDS type or a clock; locks for as long as a look at its table
// takes.
#pragma once

#include <compare>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxWritersKnown = 256;
/// Writers of any topic whose participants assert them. With more, no such assertion is believed.
inline constexpr std::size_t kMaxAssertedKnown = 1024;
/// What a writer with a lease gets beside it when it appears: until its assertions are heard.
inline constexpr SteadyNs kFirstGrace = 1'000'000'000;

enum class CommandTopic : std::uint8_t { command, object };
enum class LivelinessKind : std::uint8_t { automatic, manual_by_participant, manual_by_topic };

/// What a writer states of its liveliness. Those of one kind and length are heard by one reader.
struct LivelinessLease {
  CommandTopic topic = CommandTopic::command;
  LivelinessKind kind = LivelinessKind::automatic;
  SteadyNs length = 0;  ///< 0: endless
  friend auto operator<=>(const LivelinessLease&, const LivelinessLease&) = default;
};

/// What a writer states of itself when it is discovered.
struct WriterStatement {
  std::int32_t strength = 0;
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
  /// Removed by its participant, or that is gone. Of any topic.
  void on_removed(const Guid& writer);
  /// A writer of any topic with a finite lease, which its participant asserts together with all of that kind.
  /// Fast DDS 2.9.1 takes such an assertion for one of all participants' writers, so that one program that lives would
  /// keep the leases of those that have died. Where more than one participant asserts a kind, none is believed.
  void on_asserted(const Guid& writer, LivelinessKind kind);
  /// By a reader that asks for this lease. Of writers with another one it says nothing.
  void on_liveliness(const Guid& writer, const LivelinessLease& asked, bool alive);
  /// A sample of it was taken, which is an assertion of its liveliness.
  void on_sample(const Guid& writer, SteadyNs now);

  struct Changes {
    std::vector<WriterRecord> before{};  ///< to be told before the samples that were taken
    std::vector<WriterRecord> after{};   ///< losses: after them
    /// A writer is silent that the library, which does not know of its lease, still prefers to those that are not
    /// stronger, whether they are there or still to come.
    bool owner_silent = false;
    std::size_t refused = 0;  ///< writers not taken in since the last call, for want of room
    bool doubted = false;     ///< since the last call it has begun that assertions are not believed
  };
  [[nodiscard]] Changes take_changes(SteadyNs now);
  /// Of those with a lease that is good now.
  [[nodiscard]] BeatRecord beats(SteadyNs now) const;
  /// All that are not endless.
  [[nodiscard]] std::set<LivelinessLease> leases() const;

 private:
  struct Writer {
    WriterStatement statement{};
    bool matched = false;
    bool heard = false;       ///< by the reader of its lease: alive
    SteadyNs good_until = 0;  ///< by our own reckoning, where it is not heard
    bool lost_since = false;  ///< also if it came back
    bool told = false;        ///< as there
    WriterStatement told_statement{};
    [[nodiscard]] bool there(SteadyNs now) const {
      return matched && (statement.lease.length == 0 || heard || now < good_until);
    }
  };
  Writer* find(const Guid& writer);
  Writer* find_or_add(const Guid& writer);
  [[nodiscard]] bool believed(const Guid& writer, LivelinessKind kind) const;
  [[nodiscard]] bool holds_others_back(const Writer& silent, SteadyNs now) const;

  mutable std::mutex mutex_;
  std::map<Guid, Writer> writers_;
  std::map<Guid, LivelinessKind> asserted_;
  bool too_many_asserted_ = false;
  bool doubted_ = false;
  std::size_t refused_ = 0;
};

}  // namespace axisgate::dds
