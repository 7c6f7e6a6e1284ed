// SPDX-License-Identifier: Apache-2.0
// fast_peer DOMAIN [as_it_comes]: a DDS participant of eProsima Fast DDS that does what lines.h says, on loopback
// alone, or with the library's own transports and discovery.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "axisgatePubSubTypes.h"
#include "ros2_msgsPubSubTypes.h"
#include "tests/dds_peers/fast_ros2.hpp"
#include "tests/dds_peers/lines.h"
#include "tests/dds_peers/members.h"
#include "tests/dds_peers/raw_type.hpp"

using namespace eprosima::fastdds::dds;
using axisgate::dds_peers::RawSample;
using axisgate::dds_peers::RawType;

namespace {

using ros2_text::fill;
using ros2_text::show;

// No more instances than a gateway has axes, and no sample is lost that was sent: they are taken as they come.
constexpr int kMaxInstances = 500;
constexpr int kMaxSamplesEach = 64;
constexpr int kParticipantLease = 600;  // s

template <typename T>
T* checked(const char* what, T* entity) {
  if (entity != nullptr) return entity;
  std::fprintf(stderr, "fast_peer: no %s\n", what);
  std::exit(1);
}

// --- Samples as text -------------------------------------------------------------------------------------------------

template <typename Stamp>
void put_time(const char* name, const Stamp& stamp) {
  begin_object(name);
  put_i64("sec", stamp.sec());
  put_u64("nanosec", stamp.nanosec());
  end_object();
}
template <typename Text>
void put_text(const char* name, const Text& text) {
  ::put_text(name, text.c_str());
}
void put_guid(const char* name, const axisgate::Guid& guid) { put_hex(name, guid.data(), guid.size()); }
void put_bytes(const char* name, const std::vector<std::uint8_t>& data) { put_hex(name, data.data(), data.size()); }

#define PUT(kind, member) put_##kind(#member, sample.member());

void put_buses(const char* name, const std::vector<axisgate::BusState>& buses) {
  begin_list(name);
  for (const auto& sample : buses) {
    begin_object("");
    BUS_STATE_MEMBERS(PUT)
    end_object();
  }
  end_list();
}
void show(const axisgate::AxisState& sample) { AXIS_STATE_MEMBERS(PUT) }
void show(const axisgate::AxisEvent& sample) { AXIS_EVENT_MEMBERS(PUT) }
void show(const axisgate::GatewayState& sample) { GATEWAY_STATE_MEMBERS(PUT) }
void show(const axisgate::CommandReply& sample) { COMMAND_REPLY_MEMBERS(PUT) }
void show(const axisgate::ObjectReply& sample) { OBJECT_REPLY_MEMBERS(PUT) }
void show(const RawSample& sample) { put_bytes("payload", sample.payload); }

// --- Samples from text -----------------------------------------------------------------------------------------------

std::vector<std::uint8_t> value_bytes(const Line* line, const char* member) {
  std::vector<std::uint8_t> bytes(kMaxLine / 2);
  bytes.resize(value_hex(line, member, bytes.data(), bytes.size()));
  return bytes;
}

#define TAKE(kind, member) sample.member(value_##kind(line, #member));

void fill(const Line* line, axisgate::AxisCommand& sample) {
  AXIS_COMMAND_MEMBERS(TAKE)
  sample.gateway(value_of(line, "gateway"));
}
void fill(const Line* line, axisgate::ObjectRequest& sample) {
  OBJECT_REQUEST_MEMBERS(TAKE)
  sample.gateway(value_of(line, "gateway"));
}
void fill(const Line* line, axisgate::Heartbeat& sample) {
  HEARTBEAT_MEMBERS(TAKE)
  value_hex(line, "client", sample.client().data(), sample.client().size());
}
void fill(const Line* line, RawSample& sample) { sample.payload = value_bytes(line, "payload"); }

// --- Topics ----------------------------------------------------------------------------------------------------------

const char* text_of(InstanceStateKind state) {
  if (state == ALIVE_INSTANCE_STATE) return "alive";
  return state == NOT_ALIVE_DISPOSED_INSTANCE_STATE ? "disposed" : "no_writers";
}

template <typename Sample>
void take_all(DataReader* reader, const char* topic) {
  Sample sample;
  SampleInfo info;
  while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
    begin_line(info.valid_data ? "sample" : "instance", topic);
    ::put_text("state", text_of(info.instance_state));
    if (info.valid_data) {
      begin_object("data");
      show(sample);
      end_object();
    }
    end_line();
  }
}

template <typename Sample>
void write_one(DataWriter* writer, const Line* line) {
  Sample sample;
  fill(line, sample);
  if (!writer->write(&sample)) std::fprintf(stderr, "fast_peer: write failed\n");
}

using Take = std::function<void(DataReader*, const char*)>;
using Write = std::function<void(DataWriter*, const Line*)>;

struct TopicKind {
  const char* name;
  std::function<TypeSupport()> type;
  Take take{};
  Write write{};
  bool kept = false;  ///< transient-local
};

template <typename Type>
TypeSupport make_type() {
  return TypeSupport(new Type);
}

const std::map<std::string, TopicKind>& kinds() {
  using JointState = sensor_msgs::msg::dds_::JointState_;
  static const std::map<std::string, TopicKind> all{
      {"axis_state",
       {"axisgate/axis_state", make_type<axisgate::AxisStatePubSubType>, take_all<axisgate::AxisState>, {}, true}},
      {"axis_event",
       {"axisgate/axis_event", make_type<axisgate::AxisEventPubSubType>, take_all<axisgate::AxisEvent>, {}, true}},
      {"gateway_state",
       {"axisgate/gateway_state",
        make_type<axisgate::GatewayStatePubSubType>,
        take_all<axisgate::GatewayState>,
        {},
        true}},
      {"command_reply",
       {"axisgate/command_reply", make_type<axisgate::CommandReplyPubSubType>, take_all<axisgate::CommandReply>}},
      {"object_reply",
       {"axisgate/object_reply", make_type<axisgate::ObjectReplyPubSubType>, take_all<axisgate::ObjectReply>}},
      {"joint_states",
       {"rt/joint_states", make_type<sensor_msgs::msg::dds_::JointState_PubSubType>, take_all<JointState>}},
      {"joint_commands",
       {"rt/joint_commands", make_type<sensor_msgs::msg::dds_::JointState_PubSubType>, {}, write_one<JointState>}},
      {"diagnostics",
       {"rt/diagnostics", make_type<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>,
        take_all<diagnostic_msgs::msg::dds_::DiagnosticArray_>}},
      {"flag", {"", make_type<std_msgs::msg::dds_::Bool_PubSubType>, {}, write_one<std_msgs::msg::dds_::Bool_>}},
      {"signal", {"", make_type<std_msgs::msg::dds_::Empty_PubSubType>, {}, write_one<std_msgs::msg::dds_::Empty_>}},
      {"axis_command",
       {"axisgate/axis_command", make_type<axisgate::AxisCommandPubSubType>, {}, write_one<axisgate::AxisCommand>}},
      {"object_request",
       {"axisgate/object_request",
        make_type<axisgate::ObjectRequestPubSubType>,
        {},
        write_one<axisgate::ObjectRequest>}},
      {"heartbeat",
       {"axisgate/heartbeat", make_type<axisgate::HeartbeatPubSubType>, {}, write_one<axisgate::Heartbeat>}}};
  return all;
}

void tell_count(const char* on, const std::string& topic, const char* name, std::int64_t count) {
  begin_line(on, topic.c_str());
  put_i64(name, count);
  end_line();
}

struct Reader final : DataReaderListener {
  std::string topic;
  Take take;

  void on_data_available(DataReader* reader) override { take(reader, topic.c_str()); }
  void on_subscription_matched(DataReader*, const SubscriptionMatchedStatus& status) override {
    tell_count("matched", topic, "count", status.current_count);
  }
  void on_requested_deadline_missed(DataReader*, const RequestedDeadlineMissedStatus& status) override {
    tell_count("deadline_missed", topic, "count", status.total_count);
  }
  void on_liveliness_changed(DataReader*, const LivelinessChangedStatus& status) override {
    tell_count("liveliness", topic, "alive", status.alive_count);
  }
  void on_requested_incompatible_qos(DataReader*, const RequestedIncompatibleQosStatus& status) override {
    tell_count("incompatible", topic, "policy", status.last_policy_id);
  }
};

struct Writer final : DataWriterListener {
  std::string topic;
  Write write;
  DataWriter* writer = nullptr;

  void on_publication_matched(DataWriter*, const PublicationMatchedStatus& status) override {
    tell_count("matched", topic, "count", status.current_count);
  }
  void on_liveliness_lost(DataWriter*, const LivelinessLostStatus& status) override {
    tell_count("liveliness_lost", topic, "count", status.total_count);
  }
  void on_offered_incompatible_qos(DataWriter*, const OfferedIncompatibleQosStatus& status) override {
    tell_count("incompatible", topic, "policy", status.last_policy_id);
  }
};

ResourceLimitsQosPolicy limits() {
  ResourceLimitsQosPolicy policy;
  policy.max_instances = kMaxInstances;
  policy.max_samples_per_instance = kMaxSamplesEach;
  policy.max_samples = kMaxInstances * kMaxSamplesEach;
  return policy;
}

Duration_t milliseconds(long count) { return Duration_t(static_cast<long double>(count) / 1000); }

class Peer {
 public:
  /// `as_it_comes`: with the library's own transports and discovery, as a ROS 2 node has them.
  Peer(std::uint32_t domain, bool as_it_comes) {
    auto* factory = DomainParticipantFactory::get_instance();
    // FASTRTPS_DEFAULT_PROFILES_FILE, as rmw_fastrtps_cpp has it read.
    if (as_it_comes) factory->load_profiles();
    DomainParticipantQos qos = factory->get_default_participant_qos();
    auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    loopback->interfaceWhiteList.emplace_back("127.0.0.1");
    // Long: what is noticed earlier is noticed by what a writer states of itself.
    qos.wire_protocol().builtin.discovery_config.leaseDuration = Duration_t(kParticipantLease, 0);
    if (!as_it_comes) {
      qos.transport().use_builtin_transports = false;
      qos.transport().user_transports.push_back(loopback);
    }
    participant_ = checked("participant", factory->create_participant(domain, qos));
    publisher_ = checked("publisher", participant_->create_publisher(PUBLISHER_QOS_DEFAULT));
    subscriber_ = checked("subscriber", participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT));
  }
  ~Peer() {
    participant_->delete_contained_entities();
    DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  void make_reader(const Line& line) {
    const TopicKind& kind = kind_of(line);
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = has_word(&line, "best_effort") ? BEST_EFFORT_RELIABILITY_QOS : RELIABLE_RELIABILITY_QOS;
    qos.history().kind = KEEP_ALL_HISTORY_QOS;
    qos.resource_limits() = limits();
    const bool kept = kind.kept && !has_word(&line, "volatile");
    qos.durability().kind = kept ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    if (has_word(&line, "deadline")) qos.deadline().period = milliseconds(number_after(&line, "deadline", 0));
    if (has_word(&line, "automatic")) {
      qos.liveliness().kind = AUTOMATIC_LIVELINESS_QOS;
      qos.liveliness().lease_duration = milliseconds(number_after(&line, "automatic", 0));
    }
    Reader& reader = readers_.emplace_back();
    reader.topic = word(&line, 1);
    reader.take = has_word(&line, "raw") ? Take(take_all<RawSample>) : kind.take;
    checked("reader", subscriber_->create_datareader(topic_of(line, kind), qos, &reader));
  }

  void make_writer(const Line& line) {
    const TopicKind& kind = kind_of(line);
    DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = has_word(&line, "best_effort") ? BEST_EFFORT_RELIABILITY_QOS : RELIABLE_RELIABILITY_QOS;
    // Not all: what is acknowledged is not removed from an instance that is full.
    qos.history().kind = KEEP_LAST_HISTORY_QOS;
    qos.history().depth = kMaxSamplesEach;
    qos.resource_limits() = limits();
    qos.durability().kind = VOLATILE_DURABILITY_QOS;
    qos.writer_data_lifecycle().autodispose_unregistered_instances = false;
    if (std::string(word(&line, 1)) == "heartbeat") qos.reliability().kind = BEST_EFFORT_RELIABILITY_QOS;
    if (std::string(word(&line, 1)) == "axis_command" && !has_word(&line, "shared")) {
      qos.ownership().kind = EXCLUSIVE_OWNERSHIP_QOS;
      qos.ownership_strength().value = static_cast<std::uint32_t>(number_after(&line, "strength", 0));
    }
    for (const char* how : {"automatic", "participant", "manual"}) {
      if (!has_word(&line, how)) continue;
      const long lease = number_after(&line, how, 0);
      qos.liveliness().kind = *how == 'a'   ? AUTOMATIC_LIVELINESS_QOS
                              : *how == 'p' ? MANUAL_BY_PARTICIPANT_LIVELINESS_QOS
                                            : MANUAL_BY_TOPIC_LIVELINESS_QOS;
      qos.liveliness().lease_duration = milliseconds(lease);
      qos.liveliness().announcement_period = milliseconds(lease / 3);
    }
    Writer& writer = writers_[word(&line, 1)];
    writer.topic = word(&line, 1);
    writer.write = has_word(&line, "raw") ? Write(write_one<RawSample>) : kind.write;
    writer.writer = checked("writer", publisher_->create_datawriter(topic_of(line, kind), qos, &writer));
    const auto& guid = writer.writer->guid();
    std::vector<std::uint8_t> bytes(guid.guidPrefix.value, guid.guidPrefix.value + guid.guidPrefix.size);
    bytes.insert(bytes.end(), guid.entityId.value, guid.entityId.value + guid.entityId.size);
    begin_line("writer", writer.topic.c_str());
    put_bytes("guid", bytes);
    end_line();
  }

  void write(const Line& line) {
    Writer& writer = writers_.at(word(&line, 1));
    writer.write(writer.writer, &line);
  }
  void assert_liveliness(const Line& line) { writers_.at(word(&line, 1)).writer->assert_liveliness(); }
  void delete_writer(const Line& line) { publisher_->delete_datawriter(writers_.at(word(&line, 1)).writer); }
  void tell(const Line& line) {
    begin_line("told", word(&line, 1));
    end_line();
  }

 private:
  static const TopicKind& kind_of(const Line& line) {
    char kind[kMaxLine];
    topic_name(word(&line, 1), kind, sizeof kind);
    const auto found = kinds().find(kind);
    if (found != kinds().end()) return found->second;
    std::fprintf(stderr, "fast_peer: no topic '%s'\n", word(&line, 1));
    std::exit(1);
  }

  Topic* topic_of(const Line& line, const TopicKind& kind) {
    Topic*& topic = topics_[word(&line, 1)];
    if (topic == nullptr) {
      TypeSupport type = kind.type();
      const std::string name = type.get_type_name();
      if (has_word(&line, "raw")) type = TypeSupport(new RawType(name, type->m_isGetKeyDefined));
      type.register_type(participant_);
      char unused[kMaxLine];
      const char* const named = topic_name(word(&line, 1), unused, sizeof unused);
      topic =
          checked("topic", participant_->create_topic(named != nullptr ? named : kind.name, name, TOPIC_QOS_DEFAULT));
    }
    return topic;
  }

  DomainParticipant* participant_ = nullptr;
  Publisher* publisher_ = nullptr;
  Subscriber* subscriber_ = nullptr;
  std::map<std::string, Topic*> topics_;
  std::map<std::string, Writer> writers_;
  std::list<Reader> readers_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fputs("usage: fast_peer DOMAIN [as_it_comes]\n", stderr);
    return 2;
  }
  Peer peer(static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10)), argc == 3);
  begin_line("ready", "");
  end_line();
  const std::map<std::string, void (Peer::*)(const Line&)> verbs{
      {"reader", &Peer::make_reader},       {"writer", &Peer::make_writer},   {"write", &Peer::write},
      {"assert", &Peer::assert_liveliness}, {"delete", &Peer::delete_writer}, {"tell", &Peer::tell}};
  static Line line;
  while (read_line(&line) && word(&line, 0) != std::string("quit")) {
    const auto verb = verbs.find(word(&line, 0));
    if (verb != verbs.end())
      (peer.*verb->second)(line);
    else
      std::fprintf(stderr, "fast_peer: what is '%s'?\n", word(&line, 0));
  }
  return 0;
}
