// SPDX-License-Identifier: Apache-2.0
// Prints each state of each axis, with Fast DDS: axes_fastdds [DOMAIN]. Ends with Ctrl-C.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <axisgatePubSubTypes.h>

using namespace eprosima::fastdds::dds;

int main(int argc, char** argv) {
  const auto domain = static_cast<DomainId_t>(argc > 1 ? std::atoi(argv[1]) : 0);

  // As the gateway does by default: the loopback alone. On another host, leave these lines out or name its address.
  DomainParticipantQos participant_qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  participant_qos.transport().use_builtin_transports = false;
  participant_qos.transport().user_transports.push_back(udp);
  DomainParticipant* participant =
      DomainParticipantFactory::get_instance()->create_participant(domain, participant_qos);
  if (participant == nullptr) return 1;

  TypeSupport type(new axisgate::AxisStatePubSubType());
  type.register_type(participant);
  Topic* topic = participant->create_topic("axisgate/axis_state", type.get_type_name(), TOPIC_QOS_DEFAULT);

  // Reliable and transient-local: the last state of every axis comes at once. Up to 500 axes; the library's default
  // is 10.
  DataReaderQos qos;
  qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.resource_limits().max_instances = 500;
  qos.resource_limits().max_samples_per_instance = 1;
  qos.resource_limits().max_samples = 500;
  DataReader* reader = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
  if (reader == nullptr) return 1;

  for (;;) {
    reader->wait_for_unread_message(eprosima::fastrtps::Duration_t(1, 0));
    axisgate::AxisState axis;
    SampleInfo info;
    while (reader->take_next_sample(&axis, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      // link_state 2 is online; a value is good while its bit in `valid` is 1 (bit 2: position, bit 3: velocity).
      std::printf("%s axis %u %s  link %u  statusword %04x  position %.4f%s  velocity %.4f%s  error %04x\n", axis.gateway().c_str(), axis.axis(),
                  axis.name().c_str(), axis.link_state(), axis.statusword(), axis.position(),
                  (axis.valid() & 4) != 0 ? "" : "?", axis.velocity(), (axis.valid() & 8) != 0 ? "" : "?",
                  axis.error_code());
      std::fflush(stdout);
    }
  }
}
