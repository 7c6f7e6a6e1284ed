// SPDX-License-Identifier: Apache-2.0
// The DataWriter of a topic of replies, and the replies that wait for the readers of new clients (held_replies.hpp).
// Promises what those promise, a reply for any axis number that is asked for, a bound on what is kept for readers that
// are behind, and to wake whoever is to call write_held() when such a reader was found. Never waits.
#pragma once

#include <map>
#include <string>

#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/dds_process/publish/held_replies.hpp"
#include "gateway/upstream/dds_process/topics/to_idl.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

/// Replies that a reader may be behind with, for each axis number; and of all numbers together: beyond, it has lost
/// them.
inline constexpr std::size_t kRepliesKept = 64;
inline constexpr std::size_t kMostRepliesKept = 500 * kRepliesKept;

class ReplyWriter : private fastdds::DataWriterListener {
 public:
  ReplyWriter(Participant& participant, const std::string& name, const fastdds::TypeSupport& type,
              const GatewayId& gateway, program::Wake& wake);
  ~ReplyWriter() override;
  ReplyWriter(const ReplyWriter&) = delete;
  ReplyWriter& operator=(const ReplyWriter&) = delete;

  /// A ReplyRecord or an ObjectReplyRecord, as the topic has them.
  template <typename Reply>
  void write(const Reply& reply, SteadyNs now) {
    if (!held_.hold(reply, reply.writer, now)) write_now(reply);
  }
  /// Those that wait no longer.
  void write_held(SteadyNs now);
  [[nodiscard]] SteadyNs due() const { return held_.due(); }

 private:
  void on_publication_matched(fastdds::DataWriter* writer, const fastdds::PublicationMatchedStatus& info) override;
  void make_room(std::uint16_t axis);
  template <typename Reply>
  void write_now(const Reply& reply) {
    make_room(reply.axis);
    // What cannot be sent is in the history, or is overtaken by the next sample: there is nobody to tell.
    auto sample = to_idl(reply, gateway_);
    writer_.write(&sample);
  }

  const GatewayId& gateway_;
  program::Wake& wake_;
  HeldReplies held_;
  /// What the library keeps at most of each axis number, and in all: written since all readers had everything.
  std::map<std::uint16_t, std::size_t> kept_of_;
  std::size_t kept_ = 0;
  fastdds::DataWriter& writer_;
};

}  // namespace axisgate::dds
