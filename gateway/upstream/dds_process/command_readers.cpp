#include "gateway/upstream/dds_process/command_readers.hpp"

#include <fastrtps/utils/IPLocator.h>

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "gateway/upstream/dds_process/command_topics.hpp"
#include "gateway/upstream/dds_process/steady.hpp"
#include "gateway/upstream/dds_process/to_idl.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::rtps::WriterDiscoveryInfo;
using eprosima::fastrtps::types::ReturnCode_t;

/// Of one axis, until they are taken. Then the library takes no more, and reliable writers keep theirs.
constexpr std::int32_t kMostSamplesPerAxis = 64;

std::string where(const eprosima::fastrtps::rtps::WriterProxyData& writer) {
  for (const auto& locator : writer.remote_locators().unicast) {
    if (locator.kind == LOCATOR_KIND_UDPv4) return eprosima::fastrtps::rtps::IPLocator::toIPv4string(locator);
  }
  return {};
}

LivelinessKind to_kind(fastdds::LivelinessQosPolicyKind kind) {
  switch (kind) {
    case fastdds::AUTOMATIC_LIVELINESS_QOS:
      break;
    case fastdds::MANUAL_BY_PARTICIPANT_LIVELINESS_QOS:
      return LivelinessKind::manual_by_participant;
    case fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS:
      return LivelinessKind::manual_by_topic;
  }
  return LivelinessKind::automatic;
}

SteadyNs to_length(const eprosima::fastrtps::Duration_t& lease) {
  return lease == eprosima::fastrtps::c_TimeInfinite ? 0 : lease.seconds * kSecond + lease.nanosec;
}

}  // namespace

void WriterDiscovery::on_publisher_discovery(fastdds::DomainParticipant*, WriterDiscoveryInfo&& info) {
  const auto& data = info.info;
  const Guid writer = to_guid(data.guid());
  const auto& stated = data.m_qos.m_liveliness;
  const bool removed = info.status == WriterDiscoveryInfo::REMOVED_WRITER;
  if (!removed && to_length(stated.lease_duration) != 0 && stated.kind != fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS)
    watch_.on_asserted(writer, to_kind(stated.kind));
  const bool command = data.topicName() == kCommandTopicName;
  if (removed) {
    watch_.on_removed(writer);
  } else if (command || data.topicName() == kObjectTopicName) {
    watch_.on_discovered(writer, {.strength = static_cast<std::int32_t>(data.m_qos.m_ownershipStrength.value),
                                  .lease = {.topic = command ? CommandTopic::command : CommandTopic::object,
                                            .kind = to_kind(stated.kind),
                                            .length = to_length(stated.lease_duration)},
                                  .where = where(data)});
  }
  wake_.set();
}

CommandReaders::CommandReaders(Participant& participant, WriterWatch& watch, Wake& wake)
    : participant_(participant),
      watch_(watch),
      wake_(wake),
      commands_(make(CommandTopic::command)),
      objects_(make(CommandTopic::object)) {}

CommandReaders::~CommandReaders() {
  participant_.end_reader(*commands_);
  participant_.end_reader(*objects_);
}

fastdds::DataReader* CommandReaders::make(CommandTopic topic) {
  fastdds::DataReaderQos qos = reader_qos(topic, kMostSamplesPerAxis);
  qos.history().kind = fastdds::KEEP_ALL_HISTORY_QOS;
  const char* profile = topic == CommandTopic::command ? "axis_command" : "object_request";
  return &participant_.make_reader(name_of(topic), type_of(topic), participant_.reader_qos_of(profile, qos), this);
}

void CommandReaders::forget_owners() {
  participant_.end_reader(*commands_);
  commands_ = make(CommandTopic::command);
}

template <typename Sample>
void CommandReaders::take_from(fastdds::DataReader& reader, std::size_t most, std::vector<Record>& taken) {
  Sample sample;
  fastdds::SampleInfo info;
  while (taken.size() < most && reader.take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    const Guid writer = to_guid(info.sample_identity.writer_guid());
    watch_.on_sample(writer, steady_now());
    taken.emplace_back(to_record(sample, writer));
  }
}

std::vector<Record> CommandReaders::take(std::size_t most) {
  std::vector<Record> taken;
  take_from<AxisCommand>(*commands_, most, taken);
  take_from<ObjectRequest>(*objects_, most, taken);
  return taken;
}

void CommandReaders::on_data_available(fastdds::DataReader*) { wake_.set(); }

void CommandReaders::on_subscription_matched(fastdds::DataReader*, const fastdds::SubscriptionMatchedStatus& info) {
  const Guid writer = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.last_publication_handle));
  if (info.current_count_change > 0) {
    watch_.on_matched(writer, steady_now());
  } else {
    watch_.on_unmatched(writer);
  }
  wake_.set();
}

}  // namespace axisgate::dds
