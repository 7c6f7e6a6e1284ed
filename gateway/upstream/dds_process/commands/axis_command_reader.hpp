// SPDX-License-Identifier: Apache-2.0
// A reader of axis_command one layer below DDS. A DataReader with exclusive ownership passes on one writer's samples
// alone: of two equals the one with the lower GUID, dead or alive, for as long as its participant counts as there. This
// one announces the same QoS and hears every sample of every writer; the gateway decides whose counts. Promises each
// sample once, in its writer's order, with that writer's strength. Never judges one.
#pragma once

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>

#include "gateway/upstream/dds_process/commands/command_intake.hpp"
#include "gateway/upstream/dds_process/commands/rtps_participant.hpp"
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"
#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

class AxisCommandReader : private eprosima::fastrtps::rtps::ReaderListener {
 public:
  /// `topic`: command or shared_command. `intake` and `watch` must outlive it.
  AxisCommandReader(RtpsParticipant& participant, CommandTopic topic, CommandIntake& intake, WriterWatch& watch,
                    program::Wake& wake);
  ~AxisCommandReader() override;
  AxisCommandReader(const AxisCommandReader&) = delete;
  AxisCommandReader& operator=(const AxisCommandReader&) = delete;

 private:
  /// Takes a sample only where the intake has room: else it counts as not received, and its writer keeps it.
  class History : public eprosima::fastrtps::rtps::ReaderHistory {
   public:
    explicit History(const CommandIntake& intake);
    using ReaderHistory::received_change;
    bool received_change(eprosima::fastrtps::rtps::CacheChange_t* change, std::size_t missing) override;

   private:
    /// A full queue of commands takes stops all the same: the payload tells which it is.
    [[nodiscard]] bool is_stop(eprosima::fastrtps::rtps::CacheChange_t& change);

    const CommandIntake& intake_;
    GuardedType<AxisCommandPubSubType> type_;
  };

  using ReaderListener::onReaderMatched;
  void onReaderMatched(eprosima::fastrtps::rtps::RTPSReader* reader,
                       eprosima::fastrtps::rtps::MatchingInfo& info) override;
  void onNewCacheChangeAdded(eprosima::fastrtps::rtps::RTPSReader* reader,
                             const eprosima::fastrtps::rtps::CacheChange_t* change) override;

  const bool exclusive_;
  CommandIntake& intake_;
  WriterWatch& watch_;
  program::Wake& wake_;
  GuardedType<AxisCommandPubSubType> type_;
  History history_;
  eprosima::fastrtps::rtps::RTPSReader& reader_;
};

}  // namespace axisgate::dds
