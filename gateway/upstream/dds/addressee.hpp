// SPDX-License-Identifier: Apache-2.0
// Whether a request is for this gateway: by the key and the name that it carries (design 4).
// Promises that what may start a motor needs both, exactly, and that a stop is lost only where it names another gateway
// without a doubt. Never looks at who asks.
#pragma once

#include "gateway/upstream/dds_link/gateway_name.hpp"

namespace axisgate::dds {

enum class Addressee : std::uint8_t {
  ours,    ///< key and name
  half,    ///< one of the two is ours: nobody else will answer it
  nobody,  ///< key and name contradict each other, or there is no name while we have one
  other,   ///< a gateway of another name, which answers it
};
[[nodiscard]] Addressee addressee(const GatewayId& asked, const GatewayId& own);

}  // namespace axisgate::dds
