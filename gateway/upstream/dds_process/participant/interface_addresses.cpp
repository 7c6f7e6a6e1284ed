// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/participant/interface_addresses.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>

#include <algorithm>
#include <memory>
#include <set>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::dds {
namespace {

struct Address {
  std::string interface;
  std::string address;
};

std::vector<Address> all_addresses() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0)
    throw program::StartError(link::kExitCannotServe, "the list of network interfaces cannot be read");
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, &freeifaddrs);
  std::vector<Address> all;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = {};
    const void* inet = &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr;
    if (inet_ntop(AF_INET, inet, text, sizeof(text)) != nullptr) all.push_back({each->ifa_name, text});
  }
  return all;
}

}  // namespace

std::vector<std::string> interface_addresses(const std::vector<std::string>& names) {
  const std::vector<Address> all = all_addresses();
  std::vector<std::string> addresses;
  for (const std::string& name : names) {
    const std::size_t before = addresses.size();
    for (const Address& each : all) {
      if (each.interface == name || each.address == name) addresses.push_back(each.address);
    }
    if (addresses.size() > before) continue;
    std::vector<std::string> there;
    for (const Address& each : all) there.push_back(fmt::format("{} ({})", each.interface, each.address));
    throw program::StartError(
        link::kExitNoAddress,
        fmt::format("--interface {}: no interface of that name or address has an IPv4 address now; there are: {}", name,
                    fmt::join(there, ", ")));
  }
  std::set<std::string> seen;
  std::erase_if(addresses, [&](const std::string& each) { return !seen.insert(each).second; });
  return addresses;
}

}  // namespace axisgate::dds
