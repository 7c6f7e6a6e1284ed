// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/namesake_reader.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <utility>

#include "gateway/upstream/dds_process/command_topics.hpp"

namespace axisgate::dds {
namespace {

/// Axes of all gateways of our key, ours among them.
constexpr std::int32_t kMostStatesHeard = 4096;

fastdds::DataReaderQos namesake_qos() {
  fastdds::DataReaderQos qos;
  qos.reliability().kind = fastdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.resource_limits().max_instances = kMostStatesHeard;
  qos.resource_limits().max_samples_per_instance = 1;
  qos.resource_limits().max_samples = kMostStatesHeard;
  qos.resource_limits().allocated_samples = 0;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

}  // namespace

NamesakeReader::NamesakeReader(Participant& participant, NamesakeWatch& watch, Wake& wake)
    : participant_(participant), watch_(watch), wake_(wake) {}

NamesakeReader::~NamesakeReader() {
  if (reader_ != nullptr) participant_.end_reader(*reader_);
}

void NamesakeReader::update() {
  if (watch_.any() == (reader_ != nullptr)) return;
  if (reader_ == nullptr) {
    const fastdds::TypeSupport type(new GuardedType<AxisStatePubSubType>());
    reader_ = &participant_.make_reader(kStateTopicName, type, namesake_qos(), this);
  } else {
    participant_.end_reader(*std::exchange(reader_, nullptr));
  }
}

void NamesakeReader::on_data_available(fastdds::DataReader* reader) {
  AxisState sample;
  fastdds::SampleInfo info;
  while (reader->take_next_sample(&sample, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    if (info.valid_data)
      watch_.on_state(to_guid(info.sample_identity.writer_guid()), sample.gateway_key(), sample.axis());
  }
  wake_.set();
}

}  // namespace axisgate::dds
