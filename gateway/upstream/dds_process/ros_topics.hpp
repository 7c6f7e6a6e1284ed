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

#include "gateway/upstream/dds_process/joint_states.hpp"
#include "gateway/upstream/dds_process/participant.hpp"
#include "gateway/upstream/dds_process/ros_diagnostics.hpp"
#include "gateway/upstream/dds_process/wake.hpp"

namespace axisgate::dds {

inline constexpr SteadyNs kDiagnosticsPeriod = 1'000'000'000;
/// On change, but no more often: a drive that comes and goes must not fill the network.
inline constexpr SteadyNs kDiagnosticsPause = 100'000'000;

class RosTopics : private fastdds::DataReaderListener {
 public:
  /// `gateway`: its name, the namespace of all names. `commands`: what comes in is read.
  RosTopics(Participant& participant, Wake& wake, const std::string& gateway, SteadyNs min_period, bool commands);
  ~RosTopics() override;
  RosTopics(const RosTopics&) = delete;
  RosTopics& operator=(const RosTopics&) = delete;

  /// What our own topics publish as well.
  void on_record(const Record& record);
  /// When on_time() has something to do next.
  [[nodiscard]] SteadyNs due() const;
  void on_time(SteadyNs now, ClockDifference difference);
  /// At most `most` samples, those of single axes first; fewer: there are no more.
  [[nodiscard]] std::vector<Record> take(std::size_t most, ClockDifference difference);

 private:
  static constexpr std::size_t kTopicsOfAnAxis = 4;
  struct AxisReaders {
    std::string name{};
    std::array<fastdds::DataReader*, kTopicsOfAnAxis> readers{};
  };
  void on_data_available(fastdds::DataReader* reader) override;
  void make_readers(std::uint16_t axis, const std::string& name);
  void end_readers(AxisReaders& of);
  bool take_joint_commands(std::size_t most, ClockDifference difference, std::vector<Record>& taken);
  bool take_actions(std::uint16_t axis, std::size_t topic, fastdds::DataReader& reader, std::size_t most,
                    ClockDifference difference, std::vector<Record>& taken);

  Participant& participant_;
  Wake& wake_;
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
  std::set<fastdds::DataReader*> unread_;  ///< those that samples have come to; guarded by mutex_
};

}  // namespace axisgate::dds
