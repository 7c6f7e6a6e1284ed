// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/liveliness_readers.hpp"
#include "gateway/upstream/dds_process/steady.hpp"

#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <set>

#include "gateway/upstream/dds_process/command_topics.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

fastdds::DataReaderQos ear_qos(const LivelinessLease& lease) {
  fastdds::DataReaderQos qos = reader_qos(lease.topic, 1);
  qos.history().kind = fastdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  // Reliable: assertions come as heartbeats, which a best effort reader does not hear.
  qos.liveliness().kind = fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
  qos.liveliness().lease_duration =
      Duration_t(static_cast<std::int32_t>(lease.length / kSecond), static_cast<std::uint32_t>(lease.length % kSecond));
  return qos;
}

}  // namespace

class LivelinessReaders::Ear : private fastdds::DataReaderListener {
 public:
  Ear(Participant& participant, const LivelinessLease& lease, WriterWatch& watch, Wake& wake)
      : participant_(participant),
        lease_(lease),
        watch_(watch),
        wake_(wake),
        reader_(participant.make_reader(name_of(lease.topic), type_of(lease.topic), ear_qos(lease), this)) {}
  ~Ear() override { participant_.end_reader(reader_); }
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

 private:
  void on_data_available(fastdds::DataReader* reader) override {
    if (lease_.topic != CommandTopic::object) {
      drop_all<AxisCommand>(*reader);
    } else {
      drop_all<ObjectRequest>(*reader);
    }
  }
  void on_liveliness_changed(fastdds::DataReader*, const eprosima::fastrtps::LivelinessChangedStatus& status) override {
    const Guid writer = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(status.last_publication_handle));
    if (status.alive_count_change > 0) {
      watch_.on_liveliness(writer, lease_, true);
    } else if (status.not_alive_count_change > 0) {
      watch_.on_liveliness(writer, lease_, false);
    }
    wake_.set();
  }
  template <typename Sample>
  static void drop_all(fastdds::DataReader& reader) {
    Sample sample;
    fastdds::SampleInfo info;
    while (reader.take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
    }
  }

  Participant& participant_;
  const LivelinessLease lease_;
  WriterWatch& watch_;
  Wake& wake_;
  fastdds::DataReader& reader_;
};

LivelinessReaders::LivelinessReaders(Participant& participant, WriterWatch& watch, Wake& wake)
    : participant_(participant), watch_(watch), wake_(wake) {}

LivelinessReaders::~LivelinessReaders() = default;

void LivelinessReaders::update() {
  const std::set<LivelinessLease> wanted = watch_.leases();
  std::erase_if(ears_, [&](const auto& each) { return !wanted.contains(each.first); });
  for (const LivelinessLease& lease : wanted) {
    if (ears_.contains(lease) || ears_.size() >= kMaxLeasesHeard) continue;
    ears_.emplace(lease, std::make_unique<Ear>(participant_, lease, watch_, wake_));
  }
}

}  // namespace axisgate::dds
