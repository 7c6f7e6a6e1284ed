// SPDX-License-Identifier: Apache-2.0
// Replies to clients that are new: what is written before a client's reader and our writer know each other is lost to
// it, and these topics keep nothing. Promises a client's replies in their order; the first ones kReaderGrace after it
// has asked and its reader was found, and at most kReplyPatience after it has asked: it may have no reader at all, or
// one in another participant. Never lets one wait once kMaxRepliesHeld of them do.
#pragma once

#include <compare>
#include <map>
#include <mutex>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {

inline constexpr SteadyNs kReplyPatience = 2 * kSecond;
/// We know the reader, and it may not know us yet. Cyclone DDS seems to take nothing that was written before the first
/// heartbeat that it gets of a writer.
inline constexpr SteadyNs kReaderGrace = 250 * kMillisecond;
/// A reader that we know for so long knows us: participants announce themselves each 3 s.
inline constexpr SteadyNs kReaderSettled = 4 * kSecond;
inline constexpr std::size_t kMaxRepliesHeld = 1024;
/// Clients that are waited for, or were, and readers that are known.
inline constexpr std::size_t kMaxReplyClients = 256;
inline constexpr std::size_t kMaxReplyReaders = 1024;

class HeldReplies {
 public:
  // From any thread.
  void on_reader(const Guid& reader, SteadyNs now);
  void on_reader_gone(const Guid& reader);

  /// It is kept back; else it is to be written now.
  [[nodiscard]] bool hold(const Record& reply, const Guid& client, SteadyNs now);
  /// To be written now.
  [[nodiscard]] std::vector<Record> take(SteadyNs now);
  /// When take() has more, whatever happens.
  [[nodiscard]] SteadyNs due() const;

 private:
  struct Client {
    SteadyNs asked = 0;  ///< when its first reply came
    bool over = false;   ///< it is waited for no longer
    std::vector<Record> held{};
  };
  /// When the oldest reader of this participant was found; kNoTime: there is none.
  [[nodiscard]] SteadyNs found_at(const GuidPrefix& participant) const;
  [[nodiscard]] SteadyNs due_of(const GuidPrefix& participant, const Client& client) const;
  bool make_room();

  mutable std::mutex mutex_;
  std::map<Guid, SteadyNs> readers_;  ///< and when they were found
  std::map<GuidPrefix, Client> clients_;
  std::size_t held_ = 0;
};

}  // namespace axisgate::dds
