// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/participant/participant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <algorithm>
#include <charconv>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fstream>
#include <iterator>

#include "gateway/upstream/dds_process/participant/interface_addresses.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::types::ReturnCode_t;
using fastrtps_settings = eprosima::fastrtps::xmlparser::XMLProfileManager;

/// A peer without port: the ports of this many participants of its host are tried.
constexpr std::uint32_t kParticipantsPerPeer = 16;
// DDSI-RTPS 9.6.1: where participants announce themselves.
constexpr const char* kSpdpAddress = "239.255.0.1";
constexpr std::uint32_t spdp_port(std::uint32_t domain) { return 7400 + 250 * domain; }
constexpr const char* kParticipantProfile = "axisgate_participant";

/// ADDRESS or ADDRESS:PORT, IPv4. Port 0: none given.
Locator_t parse_locator(const std::string& option, const std::string& text, bool port_needed) {
  const std::size_t colon = text.find(':');
  const std::string address = text.substr(0, colon);
  std::uint32_t port = 0;
  bool good = IPLocator::isIPv4(address);
  if (colon != std::string::npos) {
    const auto [end, error] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), port);
    good = good && error == std::errc() && end == text.data() + text.size() && port > 0 && port <= 65535;
  } else {
    good = good && !port_needed;
  }
  Locator_t locator(LOCATOR_KIND_UDPv4, port);
  if (!good || !IPLocator::setIPv4(locator, address)) {
    throw program::StartError(
        link::kExitUsage,
        fmt::format("{} {}: give an IPv4 address{}, such as 192.168.1.5{}", option, text,
                    port_needed ? " and a port" : ", with a port or without", port_needed ? ":11811" : ""));
  }
  return locator;
}

void set_transports(fastdds::DomainParticipantQos& qos, const ParticipantOptions& options,
                    const std::vector<std::string>& addresses) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = addresses;
  udp->non_blocking_send = true;
  udp->maxInitialPeersRange = kParticipantsPerPeer;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  if (options.shared_memory) {
    qos.transport().user_transports.push_back(
        std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>());
  }
}

void set_discovery(fastdds::DomainParticipantQos& qos, const ParticipantOptions& options,
                   const std::vector<std::string>& addresses) {
  auto& builtin = qos.wire_protocol().builtin;
  for (std::size_t i = 0; i < options.discovery_servers.size(); ++i) {
    eprosima::fastrtps::rtps::RemoteServerAttributes server;
    eprosima::fastrtps::rtps::get_server_client_default_guidPrefix(static_cast<int>(i), server.guidPrefix);
    server.metatrafficUnicastLocatorList.push_back(
        parse_locator("--discovery-server", options.discovery_servers[i], true));
    builtin.discovery_config.discoveryProtocol = eprosima::fastrtps::rtps::DiscoveryProtocol_t::CLIENT;
    builtin.discovery_config.m_DiscoveryServers.push_back(server);
  }
  if (!options.discovery_servers.empty()) return;
  for (const std::string& peer : options.peers) {
    builtin.initialPeersList.push_back(parse_locator("--peer", peer, false));
  }
  const auto is_loopback = [](const std::string& address) { return address.starts_with("127."); };
  if (!options.peers.empty()) {
    // Named, these take the place of the defaults, of which one is multicast.
    for (const std::string& address : addresses) {
      Locator_t own(LOCATOR_KIND_UDPv4, 0);
      IPLocator::setIPv4(own, address);
      builtin.metatrafficUnicastLocatorList.push_back(own);
    }
  } else if (std::all_of(addresses.begin(), addresses.end(), is_loopback)) {
    // Participants of other makers (Cyclone DDS) listen to no multicast on an interface without that flag, as lo is.
    Locator_t multicast(LOCATOR_KIND_UDPv4, spdp_port(options.domain));
    IPLocator::setIPv4(multicast, kSpdpAddress);
    builtin.initialPeersList.push_back(multicast);
    Locator_t host(LOCATOR_KIND_UDPv4, 0);
    IPLocator::setIPv4(host, "127.0.0.1");
    builtin.initialPeersList.push_back(host);
  }
}

/// The two participants of this process would write straight into each other's built-in readers, and Fast DDS 2.9.1
/// does so into those of the one that was removed first (StatefulWriter::intraprocess_gap): at its end the process died
/// of it.
void keep_participants_apart() {
  eprosima::fastrtps::LibrarySettingsAttributes settings = fastrtps_settings::library_settings();
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  fastrtps_settings::library_settings(settings);
}

std::string read_qos_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw program::StartError(link::kExitCannotServe, fmt::format("--qos-file {}: cannot be read", path));
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Participant::Participant(const ParticipantOptions& options, fastdds::DomainParticipantListener* listener) {
  auto* factory = fastdds::DomainParticipantFactory::get_instance();
  if (!options.qos_file.empty()) {
    qos_text_ = read_qos_file(options.qos_file);
    if (factory->load_XML_profiles_file(options.qos_file) != ReturnCode_t::RETCODE_OK) {
      throw program::StartError(
          link::kExitCannotServe,
          fmt::format("--qos-file {}: no valid file of Fast DDS XML profiles (the lines before this one say "
                      "where)",
                      options.qos_file));
    }
  }
  keep_participants_apart();
  fastdds::DomainParticipantQos qos;
  if (in_qos_file(kParticipantProfile)) {
    if (factory->get_participant_qos_from_profile(kParticipantProfile, qos) != ReturnCode_t::RETCODE_OK) {
      throw program::StartError(
          link::kExitCannotServe,
          fmt::format("--qos-file {}: profile {} is no participant profile", options.qos_file, kParticipantProfile));
    }
  } else {
    const std::vector<std::string> addresses = interface_addresses(options.interfaces);
    set_transports(qos, options, addresses);
    set_discovery(qos, options, addresses);
    qos.wire_protocol().builtin.typelookup_config.use_client = false;
    qos.wire_protocol().builtin.typelookup_config.use_server = false;
  }
  // Two readers of Cyclone DDS that name a multicast address end Fast DDS 2.9.1 by an assertion (OutputTrafficManager).
  if (!options.multicast) qos.allocation().locators.max_multicast_locators = 0;
  qos.name("axisgate");
  participant_ = factory->create_participant(options.domain, qos, listener, fastdds::StatusMask::none());
  if (participant_ != nullptr) {
    publisher_ = participant_->create_publisher(fastdds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(fastdds::SUBSCRIBER_QOS_DEFAULT);
  }
  if (publisher_ == nullptr || subscriber_ == nullptr) {
    throw program::StartError(
        link::kExitCannotServe,
        fmt::format("the DDS participant of domain {} (--domain) cannot be made on {}: are its UDP ports (from "
                    "{}) taken or forbidden?",
                    options.domain, fmt::join(options.interfaces, ", "), spdp_port(options.domain)));
  }
}

Participant::~Participant() {
  if (participant_ == nullptr) return;
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  fastdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

bool Participant::in_qos_file(const std::string& profile) const {
  // Asking the library for a profile that is not there makes it log an error.
  return qos_text_.find('"' + profile + '"') != std::string::npos ||
         qos_text_.find('\'' + profile + '\'') != std::string::npos;
}

fastdds::Topic* Participant::find_or_make_topic(const std::string& topic, fastdds::TypeSupport type) {
  if (auto* known = dynamic_cast<fastdds::Topic*>(participant_->lookup_topicdescription(topic))) return known;
  // Readers of other makers trip over what Fast DDS tells of types; with final types nobody needs it.
  type->auto_fill_type_information(false);
  type->auto_fill_type_object(false);
  fastdds::Topic* made = nullptr;
  if (type.register_type(participant_) == ReturnCode_t::RETCODE_OK) {
    made = participant_->create_topic(topic, type.get_type_name(), fastdds::TOPIC_QOS_DEFAULT);
  }
  if (made == nullptr) throw program::StartError(link::kExitCannotServe, fmt::format("topic {} cannot be made", topic));
  return made;
}

fastdds::DataWriter& Participant::make_writer(const std::string& topic, const std::string& name,
                                              fastdds::TypeSupport type, fastdds::DataWriterQos qos,
                                              const std::vector<std::uint8_t>& user_data,
                                              fastdds::DataWriterListener* listener) {
  const std::string profile = "axisgate_" + name;
  if (in_qos_file(profile) && publisher_->get_datawriter_qos_from_profile(profile, qos) != ReturnCode_t::RETCODE_OK) {
    throw program::StartError(link::kExitCannotServe,
                              fmt::format("--qos-file: profile {} is no data_writer profile", profile));
  }
  if (!user_data.empty()) qos.user_data().data_vec(user_data);
  fastdds::DataWriter* made = publisher_->create_datawriter(find_or_make_topic(topic, std::move(type)), qos, listener);
  if (made == nullptr) {
    throw program::StartError(link::kExitCannotServe,
                              fmt::format("the writer of topic {} cannot be made: is its QoS consistent?", topic));
  }
  return *made;
}

fastdds::DataReaderQos Participant::reader_qos_of(const std::string& name, fastdds::DataReaderQos qos) const {
  const std::string profile = "axisgate_" + name;
  if (in_qos_file(profile) && subscriber_->get_datareader_qos_from_profile(profile, qos) != ReturnCode_t::RETCODE_OK) {
    throw program::StartError(link::kExitCannotServe,
                              fmt::format("--qos-file: profile {} is no data_reader profile", profile));
  }
  return qos;
}

fastdds::DataReader& Participant::make_reader(const std::string& topic, fastdds::TypeSupport type,
                                              const fastdds::DataReaderQos& qos,
                                              fastdds::DataReaderListener* listener) {
  fastdds::DataReader* made = subscriber_->create_datareader(find_or_make_topic(topic, std::move(type)), qos, listener);
  if (made == nullptr) {
    throw program::StartError(link::kExitCannotServe,
                              fmt::format("the reader of topic {} cannot be made: is its QoS consistent?", topic));
  }
  return *made;
}

void Participant::end_reader(fastdds::DataReader& reader) {
  reader.set_listener(nullptr);
  subscriber_->delete_datareader(&reader);
}

}  // namespace axisgate::dds
