// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/commands/command_readers.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <type_traits>

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/reader_qos.hpp"
#include "gateway/upstream/dds_process/topics/to_idl.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::types::ReturnCode_t;

/// Of one axis, until they are taken. Then the library takes no more, and reliable writers keep theirs.
constexpr std::int32_t kMostSamplesPerAxis = 64;
/// Clients of a whole domain, as long as their heartbeats' writers are there. The library forgets none of these for a
/// new one.
constexpr std::int32_t kMostHeartbeats = 4 * kMaxWritersKnown;

fastdds::DataReaderQos object_qos() {
  fastdds::DataReaderQos qos = object_reader_qos(kMostSamplesPerAxis);
  qos.history().kind = fastdds::KEEP_ALL_HISTORY_QOS;
  return qos;
}

// The key of a heartbeat is its client's GUID, so its handle is, too.
HeartbeatRecord end_of_heartbeat(const fastdds::SampleInfo& info) {
  HeartbeatRecord out;
  out.writer = to_guid(info.sample_identity.writer_guid());
  out.client = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.instance_handle));
  out.gone = true;
  return out;
}

}  // namespace

CommandReaders::CommandReaders(Participant& participant, std::uint32_t domain, WriterWatch& watch, program::Wake& wake)
    : participant_(participant),
      watch_(watch),
      wake_(wake),
      rtps_(domain, participant.qos()),
      exclusive_(rtps_, CommandTopic::command, intake_, watch, wake),
      shared_(rtps_, CommandTopic::shared_command, intake_, watch, wake),
      objects_(participant.make_reader(kObjectTopicName, object_type(),
                                       participant.reader_qos_of("object_request", object_qos()), this)),
      heartbeats_(participant.make_reader(
          kHeartbeatTopicName, fastdds::TypeSupport(new GuardedType<HeartbeatPubSubType>()),
          participant.reader_qos_of("heartbeat", reader_qos(false, kMostHeartbeats, 1)), this)) {}

CommandReaders::~CommandReaders() {
  participant_.end_reader(objects_);
  participant_.end_reader(heartbeats_);
}

// False: there may be more than this turn takes.
template <typename Sample>
bool CommandReaders::take_from(fastdds::DataReader& reader, std::size_t most, std::vector<Record>& taken) {
  Sample sample;
  fastdds::SampleInfo info;
  for (; most > 0; --most) {
    if (reader.take_next_sample(&sample, &info) != ReturnCode_t::RETCODE_OK) return true;
    if (!info.valid_data) {
      const bool disposed = info.instance_state == fastdds::NOT_ALIVE_DISPOSED_INSTANCE_STATE;
      if (std::is_same_v<Sample, Heartbeat> && disposed) taken.emplace_back(end_of_heartbeat(info));
      continue;
    }
    const Guid writer = to_guid(info.sample_identity.writer_guid());
    watch_.on_sample(writer, program::steady_now());
    taken.emplace_back(to_record(sample, {writer, 0, program::to_steady(info.source_timestamp.to_ns()),
                                          program::received_at(info.reception_timestamp.to_ns())}));
  }
  return false;
}

bool CommandReaders::take(std::vector<Record>& taken) {
  bool all = take_from<Heartbeat>(heartbeats_, kHeartbeatsPerTurn, taken);
  all = intake_.take(kStopsPerTurn, kCommandsPerTurn, taken) && all;
  return take_from<ObjectRequest>(objects_, kObjectsPerTurn, taken) && all;
}

void CommandReaders::on_data_available(fastdds::DataReader*) { wake_.set(); }

void CommandReaders::on_subscription_matched(fastdds::DataReader* reader,
                                             const fastdds::SubscriptionMatchedStatus& info) {
  if (reader->get_topicdescription()->get_name() != kObjectTopicName) return;
  const Guid writer = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.last_publication_handle));
  if (info.current_count_change > 0) {
    watch_.on_matched(writer, program::steady_now());
  } else {
    watch_.on_unmatched(writer);
  }
  wake_.set();
}

}  // namespace axisgate::dds
