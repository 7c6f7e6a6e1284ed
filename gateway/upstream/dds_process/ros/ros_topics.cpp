// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/ros/ros_topics.hpp"

#include <ros2_msgsPubSubTypes.h>

#include <algorithm>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <utility>

#include "gateway/upstream/dds_link/ros_names.hpp"
#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/guarded_type.hpp"
#include "gateway/upstream/dds_process/topics/reader_qos.hpp"
#include "gateway/upstream/dds_process/topics/writer_qos.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::types::ReturnCode_t;
namespace ros_std = std_msgs::msg::dds_;
using JointState = sensor_msgs::msg::dds_::JointState_;

constexpr std::int32_t kJointStatesKept = 10;
/// Of all nodes together, until they are taken.
constexpr std::int32_t kJointCommandsKept = 16;
constexpr std::int32_t kActionsKept = 8;

struct AxisTopic {
  const char* name;
  RosAction action;  ///< of enable: what true asks for
};
/// Stops first.
constexpr std::array<AxisTopic, kRosTopicsOfAnAxis> kAxisTopics{{{"quick_stop", RosAction::quick_stop},
                                                                 {"enable", RosAction::enable},
                                                                 {"fault_reset", RosAction::fault_reset},
                                                                 {"home", RosAction::home}}};

template <typename Type>
fastdds::TypeSupport ros_type() {
  return fastdds::TypeSupport(new GuardedType<Type>());
}

/// A reader that asks for less than reliable is matched with every writer that a node may have made. Of a stream the
/// next sample is better than the last one again.
fastdds::DataReaderQos ros_reader_qos(bool reliable, std::int32_t depth) {
  fastdds::DataReaderQos qos = reader_qos(reliable, 1, depth);
  qos.history().depth = depth;
  return qos;
}

SteadyNs written_at(const fastdds::SampleInfo& info, ClockDifference difference) {
  return info.source_timestamp.to_ns() - difference;
}

template <typename Item>
std::vector<Item> at_most_one_more(const std::vector<Item>& list) {
  return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), kMaxJoints + 1))};
}

JointCommandsRecord to_record(const JointState& sample, const fastdds::SampleInfo& info, ClockDifference difference) {
  JointCommandsRecord out;
  out.writer = to_guid(info.sample_identity.writer_guid());
  out.written = written_at(info, difference);
  out.received = program::received_at(info.reception_timestamp.to_ns());
  out.names = at_most_one_more(sample.name());
  for (std::string& name : out.names)
    if (name.size() > kMaxName) name.clear();
  out.positions = at_most_one_more(sample.position());
  out.velocities = at_most_one_more(sample.velocity());
  out.efforts = static_cast<std::uint32_t>(sample.effort().size());
  return out;
}

}  // namespace

RosTopics::RosTopics(Participant& participant, program::Wake& wake, const std::string& gateway, SteadyNs min_period,
                     bool commands)
    : participant_(participant),
      wake_(wake),
      gateway_(gateway),
      min_period_(min_period),
      joint_states_(participant.make_writer(ros_topic(gateway, "joint_states"), "joint_states",
                                            ros_type<sensor_msgs::msg::dds_::JointState_PubSubType>(),
                                            writer_qos(kJointStatesKept, 1, false))),
      diagnostics_(participant.make_writer(std::string(kRosDiagnostics), "diagnostics",
                                           ros_type<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>(),
                                           writer_qos(1, 1, false))),
      commands_(commands),
      diagnosis_(gateway) {
  static_assert(kAxisTopics.size() == kRosTopicsOfAnAxis);
  if (!commands) return;
  joint_commands_ = &participant.make_reader(
      ros_topic(gateway, "joint_commands"), ros_type<sensor_msgs::msg::dds_::JointState_PubSubType>(),
      participant.reader_qos_of("joint_commands", ros_reader_qos(false, kJointCommandsKept)), this);
}

RosTopics::~RosTopics() {
  if (joint_commands_ != nullptr) participant_.end_reader(*joint_commands_);
  for (auto& [axis, readers] : axes_) end_readers(readers);
}

void RosTopics::on_data_available(fastdds::DataReader* reader) {
  {
    const std::lock_guard lock(mutex_);
    unread_.insert(reader);
  }
  wake_.set();
}

// --- Out -------------------------------------------------------------------------------------------------------------

void RosTopics::on_record(const Record& record) {
  if (const auto* const state = std::get_if<StateRecord>(&record)) {
    joints_.on_state(*state);
    diagnosis_.on_state(*state);
    if (commands_) make_readers(state->axis, state->name);
  } else if (const auto* const gateway = std::get_if<GatewayRecord>(&record)) {
    joints_.on_all_known();
    diagnosis_.on_gateway(*gateway);
  }
}

SteadyNs RosTopics::due() const {
  const SteadyNs diagnosis = diagnosis_sent_ + (diagnosis_.changed() ? kDiagnosticsPause : kDiagnosticsPeriod);
  return joints_.due() ? std::min(diagnosis, joints_sent_ + min_period_) : diagnosis;
}

void RosTopics::on_time(SteadyNs now, ClockDifference difference) {
  if (joints_.due() && now >= joints_sent_ + min_period_) {
    joints_sent_ = now;
    auto message = joints_.take(difference);
    joint_states_.write(&message);
  }
  if (now >= diagnosis_sent_ + (diagnosis_.changed() ? kDiagnosticsPause : kDiagnosticsPeriod)) {
    diagnosis_sent_ = now;
    auto message = diagnosis_.take(now, difference);
    diagnostics_.write(&message);
  }
}

// --- In --------------------------------------------------------------------------------------------------------------

void RosTopics::make_readers(std::uint16_t axis, const std::string& name) {
  AxisReaders& of = axes_[axis];
  if (of.name == name) return;
  end_readers(of);
  of.name = name;
  if (name.empty()) return;
  for (std::size_t i = 0; i < kAxisTopics.size(); ++i) {
    const bool flag = kAxisTopics[i].action == RosAction::enable;
    of.readers[i] =
        &participant_.make_reader(ros_axis_topic(gateway_, name, kAxisTopics[i].name),
                                  flag ? ros_type<ros_std::Bool_PubSubType>() : ros_type<ros_std::Empty_PubSubType>(),
                                  ros_reader_qos(true, kActionsKept), this);
  }
}

void RosTopics::end_readers(AxisReaders& of) {
  for (fastdds::DataReader*& reader : of.readers) {
    if (reader == nullptr) continue;
    participant_.end_reader(*reader);
    const std::lock_guard lock(mutex_);
    unread_.erase(std::exchange(reader, nullptr));
  }
}

// False: there may be more than one turn takes.
bool RosTopics::take_joint_commands(ClockDifference difference, std::vector<Record>& taken) {
  JointState sample;
  fastdds::SampleInfo info;
  for (std::size_t i = 0; i < kJointCommandsPerTurn; ++i) {
    if (joint_commands_->take_next_sample(&sample, &info) != ReturnCode_t::RETCODE_OK) return true;
    if (info.valid_data) taken.emplace_back(to_record(sample, info, difference));
  }
  return false;
}

// How many were taken: fewer than `most`: there are no more.
std::size_t RosTopics::take_actions(std::uint16_t axis, std::size_t topic, fastdds::DataReader& reader,
                                    std::size_t most, ClockDifference difference, std::vector<RosActionRecord>& taken) {
  ros_std::Bool_ flag;
  ros_std::Empty_ nothing;
  fastdds::SampleInfo info;
  const bool has_flag = kAxisTopics[topic].action == RosAction::enable;
  for (std::size_t i = 0; i < most; ++i) {
    void* const sample = has_flag ? static_cast<void*>(&flag) : &nothing;
    if (reader.take_next_sample(sample, &info) != ReturnCode_t::RETCODE_OK) return i;
    if (!info.valid_data) continue;
    const RosAction action = has_flag && !flag.data() ? RosAction::disable : kAxisTopics[topic].action;
    taken.push_back({to_guid(info.sample_identity.writer_guid()), written_at(info, difference), axis,
                     static_cast<std::uint8_t>(action), program::received_at(info.reception_timestamp.to_ns())});
  }
  return most;
}

// One axis after another, beginning where the last turn had to end: so none of them starves another.
void RosTopics::take_topic(std::size_t topic, ClockDifference difference, Readers& unread,
                           std::vector<RosActionRecord>& taken) {
  std::size_t left = kRosActionsPerTurn;
  auto at = axes_.lower_bound(first_[topic]);
  for (std::size_t i = 0; i < axes_.size(); ++i, ++at) {
    if (at == axes_.end()) at = axes_.begin();
    fastdds::DataReader* const reader = at->second.readers[topic];
    if (reader == nullptr || unread.count(reader) == 0) continue;
    first_[topic] = at->first;
    if (left == 0) return;
    const std::size_t most = std::min<std::size_t>(left, kActionsKept);
    const std::size_t got = take_actions(at->first, topic, *reader, most, difference, taken);
    if (got < most) unread.erase(reader);
    left -= got;
  }
}

bool RosTopics::take(ClockDifference difference, std::vector<Record>& actions, std::vector<Record>& targets) {
  Readers unread;
  {
    const std::lock_guard lock(mutex_);
    unread.swap(unread_);
  }
  std::vector<RosActionRecord> taken;
  for (std::size_t topic = 0; topic < kAxisTopics.size(); ++topic) take_topic(topic, difference, unread, taken);
  const auto goes_first = [](const RosActionRecord& a, const RosActionRecord& b) {
    const auto stop = [](const RosActionRecord& each) {
      const RosAction action{each.action};
      return action == RosAction::quick_stop || action == RosAction::disable;
    };
    return stop(a) != stop(b) ? stop(a) : a.received < b.received;
  };
  std::stable_sort(taken.begin(), taken.end(), goes_first);
  actions.insert(actions.end(), taken.begin(), taken.end());
  if (unread.count(joint_commands_) != 0 && take_joint_commands(difference, targets)) unread.erase(joint_commands_);
  const std::lock_guard lock(mutex_);
  const bool all = unread.empty();
  unread_.merge(unread);
  return all;
}

}  // namespace axisgate::dds
