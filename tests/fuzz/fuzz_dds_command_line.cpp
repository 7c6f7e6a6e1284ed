// SPDX-License-Identifier: Apache-2.0
// A command line of axisgate-dds, one argument a line of the input. It is parsed, and not carried out.
#include <iostream>

#include "gateway/upstream/dds_process/options.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"

namespace axisgate::fuzz {
namespace {

void must_be_in_range(const dds::ParticipantOptions& options) {
  must(options.domain <= dds::kMaxDomain, "a domain has ports");
  must(options.interfaces.size() <= dds::kMaxInterfaces, "interfaces have their bound");
  must(options.peers.size() <= dds::kMaxPeers, "peers have their bound");
  must(options.discovery_servers.size() <= dds::kMaxDiscoveryServers, "discovery servers have their bound");
}

void dds_command_line(Bytes content) {
  std::vector<std::string> words = words_of("axisgate-dds", content);
  std::vector<char*> arguments;
  for (std::string& each : words) arguments.push_back(each.data());
  arguments.push_back(nullptr);
  // Help and complaints are not looked at.
  std::streambuf* const out = std::cout.rdbuf(nullptr);
  std::streambuf* const err = std::cerr.rdbuf(nullptr);
  const auto parsed = dds::parse_command_line(static_cast<int>(words.size()), arguments.data());
  std::cout.rdbuf(out);
  std::cerr.rdbuf(err);
  if (const auto* serve = std::get_if<dds::ServeOptions>(&parsed)) must_be_in_range(serve->participant);
  if (const auto* topics = std::get_if<dds::TopicsOptions>(&parsed)) must_be_in_range(topics->participant);
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_dds_command_line(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::dds_command_line({data, size});
  return 0;
}
