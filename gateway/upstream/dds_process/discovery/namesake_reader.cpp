// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/discovery/namesake_reader.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <utility>

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/reader_qos.hpp"

namespace axisgate::dds {
namespace {

/// Axes of all gateways of our key, ours among them.
constexpr std::int32_t kMostStatesHeard = 4096;

fastdds::DataReaderQos namesake_qos(bool reliable) { return reader_qos(reliable, kMostStatesHeard, 1); }

}  // namespace

NamesakeReader::NamesakeReader(Participant& participant, bool behind_a_server, NamesakeWatch& watch,
                               program::Wake& wake)
    : participant_(participant), watch_(watch), wake_(wake) {
  if (!behind_a_server) return;
  const fastdds::TypeSupport type(new GuardedType<GatewayStatePubSubType>());
  gateways_ = &participant_.make_reader(kGatewayTopicName, type, namesake_qos(false), this);
}

NamesakeReader::~NamesakeReader() {
  if (reader_ != nullptr) participant_.end_reader(*reader_);
  if (gateways_ != nullptr) participant_.end_reader(*gateways_);
}

void NamesakeReader::update() {
  if (watch_.any() == (reader_ != nullptr)) return;
  if (reader_ == nullptr) {
    const fastdds::TypeSupport type(new GuardedType<AxisStatePubSubType>());
    reader_ = &participant_.make_reader(kStateTopicName, type, namesake_qos(true), this);
  } else {
    participant_.end_reader(*std::exchange(reader_, nullptr));
  }
}

template <typename Sample, typename Heard>
void NamesakeReader::take_all(fastdds::DataReader& reader, const Heard& heard) {
  Sample sample;
  fastdds::SampleInfo info;
  while (reader.take_next_sample(&sample, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    const auto& writer = info.sample_identity.writer_guid();
    if (info.valid_data && writer.guidPrefix != reader.guid().guidPrefix) heard(to_guid(writer), sample);
  }
}

void NamesakeReader::on_data_available(fastdds::DataReader* reader) {
  if (reader->get_topicdescription()->get_name() == kStateTopicName) {
    take_all<AxisState>(*reader, [&](const Guid& writer, const AxisState& sample) {
      watch_.on_state(writer, sample.gateway_key(), sample.axis(), sample.name().size() != 0);
    });
  } else {
    take_all<GatewayState>(*reader, [&](const Guid& writer, const GatewayState& sample) {
      watch_.on_gateway(writer, sample.gateway_key());
    });
  }
  wake_.set();
}

void NamesakeReader::on_subscription_matched(fastdds::DataReader* reader,
                                             const fastdds::SubscriptionMatchedStatus& info) {
  if (reader->get_topicdescription()->get_name() == kStateTopicName || info.current_count_change > 0) return;
  watch_.on_gateway_gone(to_guid(eprosima::fastrtps::rtps::iHandle2GUID(info.last_publication_handle)));
  wake_.set();
}

}  // namespace axisgate::dds
