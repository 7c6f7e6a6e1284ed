// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/addressee.hpp"

namespace axisgate::dds {

Addressee addressee(const GatewayId& asked, const GatewayId& own) {
  if (asked == own) return Addressee::ours;
  // Two names may have one key: the key of another name is that gateway's, also where it is ours.
  const bool agrees = asked.key == gateway_key(asked.name);
  if (agrees && !asked.name.empty()) return Addressee::other;
  if (asked.key == own.key || asked.name == own.name) return Addressee::half;
  return Addressee::nobody;
}

}  // namespace axisgate::dds
