// SPDX-License-Identifier: Apache-2.0
// The readers of what clients send: axis_command, object_request and heartbeat.
// Promises that samples stay in the library, which holds their writers back, or in a bounded queue, until they are
// taken; listeners only note and wake. Never judges a sample.
#pragma once

#include <vector>

#include "gateway/upstream/dds_process/commands/axis_command_reader.hpp"
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"
#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

/// What one turn takes of each kind.
inline constexpr std::size_t kHeartbeatsPerTurn = 64;
inline constexpr std::size_t kStopsPerTurn = 64;
inline constexpr std::size_t kCommandsPerTurn = 64;
inline constexpr std::size_t kObjectsPerTurn = 16;
inline constexpr std::size_t kSamplesPerTurn = kHeartbeatsPerTurn + kStopsPerTurn + kCommandsPerTurn + kObjectsPerTurn;

class CommandReaders : private fastdds::DataReaderListener {
 public:
  CommandReaders(Participant& participant, std::uint32_t domain, WriterWatch& watch, program::Wake& wake);
  ~CommandReaders() override;
  CommandReaders(const CommandReaders&) = delete;
  CommandReaders& operator=(const CommandReaders&) = delete;

  /// Of each kind what one turn takes, so that none starves another: signs of life, stops, commands, objects. False:
  /// there are more.
  bool take(std::vector<Record>& taken);
  /// Of the readers of axis_command.
  [[nodiscard]] RtpsParticipant& participant_of_commands() { return rtps_; }

 private:
  void on_data_available(fastdds::DataReader* reader) override;
  void on_subscription_matched(fastdds::DataReader* reader, const fastdds::SubscriptionMatchedStatus& info) override;
  template <typename Sample>
  bool take_from(fastdds::DataReader& reader, std::size_t most, std::vector<Record>& taken);

  Participant& participant_;
  WriterWatch& watch_;
  program::Wake& wake_;
  CommandIntake intake_;
  RtpsParticipant rtps_;
  AxisCommandReader exclusive_;
  AxisCommandReader shared_;
  fastdds::DataReader& objects_;
  fastdds::DataReader& heartbeats_;
};

}  // namespace axisgate::dds
