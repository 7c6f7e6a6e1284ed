// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_link/gateway_name.hpp"

#include <algorithm>
#include <boost/crc.hpp>

namespace axisgate::dds {

std::uint32_t gateway_key(std::string_view name) {
  boost::crc_32_type crc;
  crc.process_bytes(name.data(), name.size());
  return crc.checksum();
}

bool is_gateway_name(std::string_view name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto may_follow = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= kMaxGatewayName && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), may_follow);
}

}  // namespace axisgate::dds
