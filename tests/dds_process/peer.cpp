// SPDX-License-Identifier: Apache-2.0
#include "tests/dds_process/peer.hpp"

#include <axisgatePubSubTypes.h>
#include <ros2_msgsPubSubTypes.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <condition_variable>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <mutex>

namespace axisgate::dds::test {

namespace fastdds = eprosima::fastdds::dds;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

namespace {

template <typename Sample>
struct TypeOf;
template <>
struct TypeOf<AxisState> {
  using Type = AxisStatePubSubType;
};
template <>
struct TypeOf<AxisEvent> {
  using Type = AxisEventPubSubType;
};
template <>
struct TypeOf<GatewayState> {
  using Type = GatewayStatePubSubType;
};
template <>
struct TypeOf<CommandReply> {
  using Type = CommandReplyPubSubType;
};
template <>
struct TypeOf<ObjectReply> {
  using Type = ObjectReplyPubSubType;
};
template <>
struct TypeOf<AxisCommand> {
  using Type = AxisCommandPubSubType;
};
template <>
struct TypeOf<Heartbeat> {
  using Type = HeartbeatPubSubType;
};
template <>
struct TypeOf<ObjectRequest> {
  using Type = ObjectRequestPubSubType;
};
template <>
struct TypeOf<sensor_msgs::msg::dds_::JointState_> {
  using Type = sensor_msgs::msg::dds_::JointState_PubSubType;
};
template <>
struct TypeOf<std_msgs::msg::dds_::Empty_> {
  using Type = std_msgs::msg::dds_::Empty_PubSubType;
};

/// Bytes in place of a state.
class RawStates : public dds_peers::RawType {
 public:
  RawStates() : RawType(AxisStatePubSubType().getName(), true) {}
};
template <>
struct TypeOf<dds_peers::RawSample> {
  using Type = RawStates;
};

template <typename Sample>
class FastReader : public Reader<Sample> {
 public:
  FastReader(fastdds::Subscriber* subscriber, fastdds::Topic* topic, const fastdds::DataReaderQos& qos)
      : subscriber_(subscriber), reader_(subscriber->create_datareader(topic, qos)) {}
  ~FastReader() override { subscriber_->delete_datareader(reader_); }

  std::optional<Sample> next_within(std::chrono::milliseconds time) override {
    const auto until = std::chrono::steady_clock::now() + time;
    for (;;) {
      Sample sample;
      fastdds::SampleInfo info;
      if (reader_->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) return sample;
        continue;
      }
      const auto left = until - std::chrono::steady_clock::now();
      if (left.count() <= 0) return std::nullopt;
      reader_->wait_for_unread_message(Duration_t(std::chrono::duration<long double>(left).count()));
    }
  }

  bool matched() override {
    fastdds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count > 0;
  }

 private:
  fastdds::Subscriber* subscriber_;
  fastdds::DataReader* reader_;
};

template <typename Sample>
class FastWriter : public Writer<Sample>, private fastdds::DataWriterListener {
 public:
  FastWriter(fastdds::Publisher* publisher, fastdds::Topic* topic, const fastdds::DataWriterQos& qos)
      : publisher_(publisher), writer_(publisher->create_datawriter(topic, qos, this)) {}
  ~FastWriter() override {
    // Fast DDS 2.9.1 frees a writer's samples while its heartbeat still goes through them, and then goes on for hours
    // (StatefulWriter::add_gaps_for_holes_in_history_). Nobody is sent a heartbeat where all is acknowledged.
    writer_->wait_for_acknowledgments(Duration_t(5));
    publisher_->delete_datawriter(writer_);
  }

  bool write(Sample sample) override { return writer_->write(&sample); }
  bool wait_matched() override {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return matched_ > 0; });
  }
  bool matched() override {
    const std::lock_guard lock(mutex_);
    return matched_ > 0;
  }
  void assert_liveliness() override { writer_->assert_liveliness(); }
  [[nodiscard]] Guid guid() const override {
    Guid bytes{};
    const auto& guid = writer_->guid();
    auto at = std::copy_n(guid.guidPrefix.value, 12, bytes.begin());
    std::copy_n(guid.entityId.value, 4, at);
    return bytes;
  }

 private:
  void on_publication_matched(fastdds::DataWriter*, const fastdds::PublicationMatchedStatus& info) override {
    const std::lock_guard lock(mutex_);
    matched_ = info.current_count;
    changed_.notify_all();
  }

  fastdds::Publisher* publisher_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int matched_ = 0;
  fastdds::DataWriter* writer_;
};

fastdds::LivelinessQosPolicyKind kind_of(Liveliness liveliness) {
  switch (liveliness) {
    case Liveliness::manual_by_participant:
      return fastdds::MANUAL_BY_PARTICIPANT_LIVELINESS_QOS;
    case Liveliness::manual_by_topic:
      return fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
    case Liveliness::automatic:
      break;
  }
  return fastdds::AUTOMATIC_LIVELINESS_QOS;
}

}  // namespace

struct Peer::Impl {
  fastdds::DomainParticipant* participant = nullptr;
  fastdds::Publisher* publisher = nullptr;
  fastdds::Subscriber* subscriber = nullptr;

  template <typename Sample>
  fastdds::Topic* topic(const std::string& name) {
    if (auto* known = dynamic_cast<fastdds::Topic*>(participant->lookup_topicdescription(name))) return known;
    fastdds::TypeSupport type(new typename TypeOf<Sample>::Type());
    type.register_type(participant);
    return participant->create_topic(name, type.get_type_name(), fastdds::TOPIC_QOS_DEFAULT);
  }
};

Peer::Peer(std::uint32_t domain) : impl_(std::make_unique<Impl>()) {
  fastdds::DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  impl_->participant = fastdds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  impl_->publisher = impl_->participant->create_publisher(fastdds::PUBLISHER_QOS_DEFAULT);
  impl_->subscriber = impl_->participant->create_subscriber(fastdds::SUBSCRIBER_QOS_DEFAULT);
}

Peer::~Peer() {
  impl_->participant->delete_contained_entities();
  fastdds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

template <typename Sample>
std::unique_ptr<Reader<Sample>> Peer::reader(const std::string& topic, const ReaderSettings& settings) {
  fastdds::DataReaderQos qos;
  qos.reliability().kind = fastdds::RELIABLE_RELIABILITY_QOS;
  if (settings.transient_local) qos.durability().kind = fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  if (settings.exclusive) qos.ownership().kind = fastdds::EXCLUSIVE_OWNERSHIP_QOS;
  qos.history().kind = settings.depth == 0 ? fastdds::KEEP_ALL_HISTORY_QOS : fastdds::KEEP_LAST_HISTORY_QOS;
  if (settings.depth != 0) qos.history().depth = settings.depth;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return std::make_unique<FastReader<Sample>>(impl_->subscriber, impl_->topic<Sample>(topic), qos);
}

template <typename Sample>
std::unique_ptr<Writer<Sample>> Peer::writer(const std::string& topic, const WriterSettings& settings) {
  fastdds::DataWriterQos qos;
  if (settings.exclusive) {
    qos.ownership().kind = fastdds::EXCLUSIVE_OWNERSHIP_QOS;
    qos.ownership_strength().value = settings.strength;
  }
  if (settings.transient_local) qos.durability().kind = fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fastdds::KEEP_ALL_HISTORY_QOS;
  qos.reliable_writer_qos().times.heartbeatPeriod =
      settings.heartbeats ? Duration_t(0, 20'000'000) : eprosima::fastrtps::c_TimeInfinite;
  // Of a topic without keys Fast DDS 2.9.1 takes 0 for no samples at all.
  qos.resource_limits().max_samples = std::is_same_v<Sample, std_msgs::msg::dds_::Empty_> ? 16 : 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.liveliness().kind = kind_of(settings.liveliness);
  if (settings.lease.count() != 0) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(settings.lease);
    const auto rest = std::chrono::nanoseconds(settings.lease - seconds);
    qos.liveliness().lease_duration =
        Duration_t(static_cast<std::int32_t>(seconds.count()), static_cast<std::uint32_t>(rest.count()));
    qos.liveliness().announcement_period = Duration_t(static_cast<long double>(settings.lease.count()) / 3000.0L);
  }
  return std::make_unique<FastWriter<Sample>>(impl_->publisher, impl_->topic<Sample>(topic), qos);
}

template std::unique_ptr<Reader<AxisState>> Peer::reader(const std::string&, const ReaderSettings&);
template std::unique_ptr<Reader<AxisEvent>> Peer::reader(const std::string&, const ReaderSettings&);
template std::unique_ptr<Reader<GatewayState>> Peer::reader(const std::string&, const ReaderSettings&);
template std::unique_ptr<Reader<CommandReply>> Peer::reader(const std::string&, const ReaderSettings&);
template std::unique_ptr<Reader<ObjectReply>> Peer::reader(const std::string&, const ReaderSettings&);
template std::unique_ptr<Reader<sensor_msgs::msg::dds_::JointState_>> Peer::reader(const std::string&,
                                                                                   const ReaderSettings&);
template std::unique_ptr<Writer<AxisCommand>> Peer::writer(const std::string&, const WriterSettings&);
template std::unique_ptr<Writer<Heartbeat>> Peer::writer(const std::string&, const WriterSettings&);
template std::unique_ptr<Writer<std_msgs::msg::dds_::Empty_>> Peer::writer(const std::string&, const WriterSettings&);
template std::unique_ptr<Writer<dds_peers::RawSample>> Peer::writer(const std::string&, const WriterSettings&);
template std::unique_ptr<Writer<ObjectRequest>> Peer::writer(const std::string&, const WriterSettings&);

AxisCommand command(std::uint16_t axis, std::uint64_t request_id) {
  AxisCommand sample;
  sample.axis(axis);
  sample.request_id(request_id);
  return sample;
}

std::optional<CommandRecord> command_of(Child& child, const Guid& writer) {
  while (std::optional<CommandRecord> record = child.next<CommandRecord>())
    if (record->writer == writer) return record;
  return std::nullopt;
}

}  // namespace axisgate::dds::test
