// SPDX-License-Identifier: Apache-2.0
// The topics by which ROS 2 nodes know this gateway: joint_states and diagnostics go out, joint_commands and, for each
// axis, enable, quick_stop, fault_reset and home come in. Promises joint_states once in each period at most, whichever
// axes have changed; diagnostics once a second and on change; that samples stay in the library until they are taken.
// Never judges a sample.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/dds_process/ros/joint_states.hpp"
#include "gateway/upstream/dds_process/ros/ros_diagnostics.hpp"
#include "gateway/upstream/program/wake.hpp"

namespace axisgate::dds {

inline constexpr SteadyNs kDiagnosticsPeriod = 1'000'000'000;
/// On change, but no more often: a drive that comes and goes must not fill the network.
inline constexpr SteadyNs kDiagnosticsPause = 100'000'000;

/// What one turn takes of each of the topics that single axes have, and of joint_commands.
inline constexpr std::size_t kRosActionsPerTurn = 32;
inline constexpr std::size_t kRosTopicsOfAnAxis = 4;
inline constexpr std::size_t kJointCommandsPerTurn = 16;
inline constexpr std::size_t kRosSamplesPerTurn = kRosTopicsOfAnAxis * kRosActionsPerTurn + kJointCommandsPerTurn;

class RosTopics : private fastdds::DataReaderListener {
 public:
  /// `gateway`: its name, the namespace of all names. `commands`: what comes in is read.
  RosTopics(Participant& participant, program::Wake& wake, const std::string& gateway, SteadyNs min_period,
            bool commands);
  ~RosTopics() override;
  RosTopics(const RosTopics&) = delete;
  RosTopics& operator=(const RosTopics&) = delete;

  /// What our own topics publish as well.
  void on_record(const Record& record);
  /// When on_time() has something to do next.
  [[nodiscard]] SteadyNs due() const;
  void on_time(SteadyNs now, ClockDifference difference);
  /// What one turn takes: of the topics of single axes, stops first and else as they were received, and of
  /// joint_commands. False: there may be more.
  bool take(ClockDifference difference, std::vector<Record>& actions, std::vector<Record>& targets);

 private:
  struct AxisReaders {
    std::string name{};
    std::array<fastdds::DataReader*, kRosTopicsOfAnAxis> readers{};
  };
  void on_data_available(fastdds::DataReader* reader) override;
  void make_readers(std::uint16_t axis, const std::string& name);
  void end_readers(AxisReaders& of);
  using Readers = std::set<fastdds::DataReader*>;
  bool take_joint_commands(ClockDifference difference, std::vector<Record>& taken);
  void take_topic(std::size_t topic, ClockDifference difference, Readers& unread, std::vector<RosActionRecord>& taken);
  std::size_t take_actions(std::uint16_t axis, std::size_t topic, fastdds::DataReader& reader, std::size_t most,
                           ClockDifference difference, std::vector<RosActionRecord>& taken);

  Participant& participant_;
  program::Wake& wake_;
  std::string gateway_;
  SteadyNs min_period_;
  fastdds::DataWriter& joint_states_;
  fastdds::DataWriter& diagnostics_;
  fastdds::DataReader* joint_commands_ = nullptr;
  bool commands_;
  JointStates joints_;
  RosDiagnostics diagnosis_;
  SteadyNs joints_sent_ = 0;
  SteadyNs diagnosis_sent_ = 0;
  std::map<std::uint16_t, AxisReaders> axes_;
  std::mutex mutex_;
  /// The axis that comes first of each topic, where one turn could not take all.
  std::array<std::uint16_t, kRosTopicsOfAnAxis> first_{};
  Readers unread_;  ///< those that samples have come to; guarded by mutex_
};

}  // namespace axisgate::dds
