// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/commands/liveliness_readers.hpp"

#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <set>

#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

fastdds::DataReaderQos ear_qos(const LivelinessLease& lease) {
  fastdds::DataReaderQos qos = object_reader_qos(1);
  // Reliable: assertions come as heartbeats, which a best effort reader does not hear.
  qos.liveliness().kind = fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
  qos.liveliness().lease_duration =
      Duration_t(static_cast<std::int32_t>(lease.length / kSecond), static_cast<std::uint32_t>(lease.length % kSecond));
  return qos;
}

}  // namespace

class LivelinessReaders::Ear {
 public:
  Ear(const LivelinessLease& lease, WriterWatch& watch, program::Wake& wake)
      : lease_(lease), watch_(watch), wake_(wake) {}
  virtual ~Ear() = default;
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

 protected:
  void on_change(const eprosima::fastrtps::LivelinessChangedStatus& status) {
    const Guid writer = to_guid(eprosima::fastrtps::rtps::iHandle2GUID(status.last_publication_handle));
    if (status.alive_count_change > 0) {
      watch_.on_liveliness(writer, lease_, true);
    } else if (status.not_alive_count_change > 0) {
      watch_.on_liveliness(writer, lease_, false);
    }
    wake_.set();
  }

 private:
  const LivelinessLease lease_;
  WriterWatch& watch_;
  program::Wake& wake_;
};

class LivelinessReaders::CommandEar final : public Ear, private rtps::ReaderListener {
 public:
  CommandEar(RtpsParticipant& participant, const LivelinessLease& lease, WriterWatch& watch, program::Wake& wake)
      : Ear(lease, watch, wake),
        history_(command_history()),
        reader_(participant.make_reader(lease, history_, *this)) {}
  ~CommandEar() override { RtpsParticipant::end_reader(reader_); }

 private:
  void on_liveliness_changed(rtps::RTPSReader*, const eprosima::fastrtps::LivelinessChangedStatus& status) override {
    on_change(status);
  }
  void onNewCacheChangeAdded(rtps::RTPSReader*, const rtps::CacheChange_t* change) override {
    // The library removes what it has given us as const.
    history_.remove_change(const_cast<rtps::CacheChange_t*>(change));
  }

  rtps::ReaderHistory history_;
  rtps::RTPSReader& reader_;
};

class LivelinessReaders::ObjectEar final : public Ear, private fastdds::DataReaderListener {
 public:
  ObjectEar(Participant& participant, const LivelinessLease& lease, WriterWatch& watch, program::Wake& wake)
      : Ear(lease, watch, wake),
        participant_(participant),
        reader_(participant.make_reader(kObjectTopicName, object_type(), ear_qos(lease), this)) {}
  ~ObjectEar() override { participant_.end_reader(reader_); }

 private:
  void on_data_available(fastdds::DataReader* reader) override {
    ObjectRequest sample;
    fastdds::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
    }
  }
  void on_liveliness_changed(fastdds::DataReader*, const eprosima::fastrtps::LivelinessChangedStatus& status) override {
    on_change(status);
  }

  Participant& participant_;
  fastdds::DataReader& reader_;
};

LivelinessReaders::LivelinessReaders(RtpsParticipant& commands, Participant& objects, WriterWatch& watch,
                                     program::Wake& wake)
    : commands_(commands), objects_(objects), watch_(watch), wake_(wake) {}

LivelinessReaders::~LivelinessReaders() = default;

void LivelinessReaders::update() {
  const std::set<LivelinessLease> wanted = watch_.leases();
  std::erase_if(ears_, [&](const auto& each) { return !wanted.contains(each.first); });
  for (const LivelinessLease& lease : wanted) {
    if (ears_.contains(lease) || ears_.size() >= kMaxLeasesHeard) continue;
    if (lease.topic == CommandTopic::object) {
      ears_.emplace(lease, std::make_unique<ObjectEar>(objects_, lease, watch_, wake_));
    } else {
      ears_.emplace(lease, std::make_unique<CommandEar>(commands_, lease, watch_, wake_));
    }
  }
}

}  // namespace axisgate::dds
