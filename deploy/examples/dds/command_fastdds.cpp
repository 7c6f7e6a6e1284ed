// SPDX-License-Identifier: Apache-2.0
// Commands one axis, with Fast DDS: command_fastdds DOMAIN GATEWAY AXIS POSITION. Enables the axis, moves it to
// POSITION (rad or m) and keeps it until Ctrl-C; then disables it. GATEWAY is "" for a gateway without a name.
#include <axisgatePubSubTypes.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

using namespace eprosima::fastdds::dds;
volatile std::sig_atomic_t ended = 0;
DataWriter *commands, *heartbeats;
DataReader* replies;
DomainParticipant* participant;
axisgate::Heartbeat heartbeat;  // its client is our writer of commands
axisgate::AxisCommand command;
std::uint32_t crc32(const char* text) {  // IEEE 802.3, as zlib's: the key of a gateway's name
  std::uint32_t crc = 0xFFFFFFFF;
  for (; *text != 0; ++text)
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc ^ *text >> bit) & 1 ? 0xEDB88320 : 0);
  return ~crc;
}

// What keeps the axis ours while we write nothing: either of the two would do. Without a sign of life it is stopped.
void beat() {
  heartbeat.counter(heartbeat.counter() + 1);
  heartbeats->write(&heartbeat);
  commands->assert_liveliness();
  usleep(50'000);
}

// Sends the command with a new id, and again with the same id until a reply comes: it is carried out once.
// The result: 2 done, 0 no reply.
int ask(std::uint8_t what, std::uint32_t mask = 0) {
  command.request_id(command.request_id() + 1);
  command.command(what);
  command.mask(mask);
  for (int turn = 0; turn < 200; ++turn) {
    if (turn % 20 == 0) commands->write(&command);
    beat();
    axisgate::CommandReply reply;
    for (SampleInfo info; replies->take_next_sample(&reply, &info) == ReturnCode_t::RETCODE_OK;) {
      if (reply.writer() != heartbeat.client() || reply.request_id() != command.request_id()) continue;
      std::printf("command %u: result %u, detail 0x%x\n", what, reply.result(), reply.detail());
      std::fflush(stdout);
      if (reply.result() != 21) return reply.result();
      if (reply.detail() >= 2) return static_cast<int>(reply.detail());  // 21: its reply was lost, and this was its result
    }
  }
  return std::printf("command %u: no reply\n", what), 0;
}
template <typename Type>
Topic* topic(const char* name) {
  TypeSupport type(new Type);
  type.register_type(participant);
  return participant->create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT);
}

int main(int argc, char** argv) {
  if (argc != 5) return std::fputs("usage: command_fastdds DOMAIN GATEWAY AXIS POSITION\n", stderr), 64;
  std::signal(SIGINT, [](int) { ended = 1; });
  DomainParticipantQos here;  // the loopback alone, as the gateway by default
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  here.transport().use_builtin_transports = false;
  here.transport().user_transports.push_back(udp);
  participant = DomainParticipantFactory::get_instance()->create_participant(std::atoi(argv[1]), here);
  if (participant == nullptr) return 1;
  DataWriterQos qos;  // reliable, as it comes
  qos.ownership().kind = EXCLUSIVE_OWNERSHIP_QOS;
  qos.ownership_strength().value = 10;  // a stronger writer takes the axis, a weaker or equal one does not
  qos.liveliness().kind = MANUAL_BY_TOPIC_LIVELINESS_QOS;
  qos.liveliness().lease_duration = {1, 0};
  auto* to = participant->create_publisher(PUBLISHER_QOS_DEFAULT);
  commands = to->create_datawriter(topic<axisgate::AxisCommandPubSubType>("axisgate/axis_command"), qos);
  heartbeats = to->create_datawriter(topic<axisgate::HeartbeatPubSubType>("axisgate/heartbeat"), DataWriterQos());
  DataReaderQos all;
  all.reliability().kind = RELIABLE_RELIABILITY_QOS;
  all.resource_limits().max_instances = 500;  // everybody's replies come here
  all.resource_limits().max_samples = 500 * all.resource_limits().max_samples_per_instance;
  auto* from = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  replies = from->create_datareader(topic<axisgate::CommandReplyPubSubType>("axisgate/command_reply"), all);
  std::memcpy(heartbeat.client().data(), &commands->guid(), 16);
  command.gateway(argv[2]);
  command.gateway_key(crc32(argv[2]));
  command.axis(static_cast<std::uint16_t>(std::atoi(argv[3])));
  command.target_position(std::atof(argv[4]));
  const int enabled = ask(1);
  if (enabled == 7 || enabled >= 16) return 1;  // another client's: a disable of ours would stop that motor
  const bool moves = enabled == 2 && ask(6, axisgate::HAS_TARGET_POSITION) == 2;
  while (ended == 0 && moves) beat();  // the reply says that the move has begun; AxisState, where it is
  return ask(2) == 2 && ask(13) == 2 ? 0 : 1;
}
