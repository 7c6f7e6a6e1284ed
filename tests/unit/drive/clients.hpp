// SPDX-License-Identifier: Apache-2.0
// Clients as a server would know them, for tests of ownership.
// Promises that two of one name come from one address. Never speaks to anything.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "gateway/image/lease.hpp"

namespace axisgate::test {

[[nodiscard]] inline std::shared_ptr<ClientLife> client(ClientId id, const std::string& name,
                                                        Role role = Role::operator_, std::uint8_t rank = 0) {
  auto life = std::make_shared<ClientLife>();
  life->id = id;
  life->name = name;
  life->role = role;
  life->rank = rank;
  std::copy_n(name.begin(), std::min(name.size(), life->origin.size()), life->origin.begin());
  return life;
}

}  // namespace axisgate::test
