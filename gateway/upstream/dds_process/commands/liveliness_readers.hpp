// SPDX-License-Identifier: Apache-2.0
// Readers that hear no more than whether writers are alive: one for each lease that a writer of commands states.
// Promises the library's own verdict on each such writer; the readers of commands ask for no lease, since they would
// not be matched with writers that state none, and the library then watches nobody for them. Each is of the participant
// whose reader takes the commands, so that a writer meets that one first: what it wrote to a reader of its lease alone
// would be lost. Never takes a sample for use.
#pragma once

#include <map>
#include <memory>

#include "gateway/upstream/dds_process/commands/rtps_participant.hpp"
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"
#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

/// Leases of different length, topic or ownership at the same time. Of writers with others the samples alone count.
inline constexpr std::size_t kMaxLeasesHeard = 24;

class LivelinessReaders {
 public:
  /// `commands`: of the readers of axis_command; `objects`: of that of object_request.
  LivelinessReaders(RtpsParticipant& commands, Participant& objects, WriterWatch& watch, program::Wake& wake);
  ~LivelinessReaders();
  LivelinessReaders(const LivelinessReaders&) = delete;
  LivelinessReaders& operator=(const LivelinessReaders&) = delete;

  /// Makes those that are missing and ends those that nobody needs any more.
  void update();

 private:
  class Ear;
  class CommandEar;
  class ObjectEar;
  RtpsParticipant& commands_;
  Participant& objects_;
  WriterWatch& watch_;
  program::Wake& wake_;
  std::map<LivelinessLease, std::unique_ptr<Ear>> ears_;
};

}  // namespace axisgate::dds
