// SPDX-License-Identifier: Apache-2.0
// The IPv4 addresses of network interfaces that were named in the configuration.
// Promises at least one address for each name, or a StartError that lists the interfaces there are.
// Never adds an interface that was not named.
#pragma once

#include <string>
#include <vector>

namespace axisgate::dds {

/// An IPv4 address stands for itself, if an interface of this host has it.
[[nodiscard]] std::vector<std::string> interface_addresses(const std::vector<std::string>& names);

}  // namespace axisgate::dds
