// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/rtps_participant.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>

#include "gateway/upstream/dds_link/exit_codes.hpp"
#include "gateway/upstream/dds_process/start_error.hpp"

namespace axisgate::dds {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

// What is a participant's own is left out: its GUID prefix and its number.
rtps::RTPSParticipantAttributes attributes_of(const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  rtps::RTPSParticipantAttributes out;
  const auto& wire = qos.wire_protocol();
  out.builtin = wire.builtin;
  out.port = wire.port;
  out.throughputController = wire.throughput_controller;
  out.defaultUnicastLocatorList = wire.default_unicast_locator_list;
  out.defaultMulticastLocatorList = wire.default_multicast_locator_list;
  out.default_external_unicast_locators = wire.default_external_unicast_locators;
  out.ignore_non_matching_locators = wire.ignore_non_matching_locators;
  const auto& transport = qos.transport();
  out.userTransports = transport.user_transports;
  out.useBuiltinTransports = transport.use_builtin_transports;
  out.sendSocketBufferSize = transport.send_socket_buffer_size;
  out.listenSocketBufferSize = transport.listen_socket_buffer_size;
  out.allocation = qos.allocation();
  out.properties = qos.properties();
  out.flow_controllers = qos.flow_controllers();
  out.setName("axisgate commands");
  return out;
}

}  // namespace

RtpsParticipant::RtpsParticipant(std::uint32_t domain, const eprosima::fastdds::dds::DomainParticipantQos& qos)
    : participant_(rtps::RTPSDomain::createParticipant(domain, attributes_of(qos))) {
  if (participant_ == nullptr)
    throw StartError(kExitParticipant, "the DDS participant that reads commands cannot be made");
}

RtpsParticipant::~RtpsParticipant() { rtps::RTPSDomain::removeRTPSParticipant(participant_); }

}  // namespace axisgate::dds
