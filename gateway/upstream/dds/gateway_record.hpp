// SPDX-License-Identifier: Apache-2.0
// The gateway and its buses as a sample of gateway_state.
// Promises the numbers that the registers of the gateway and of the buses show, gathered when it is called.
// Never more buses than fit one packet.
#pragma once

#include "gateway/image/process_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

[[nodiscard]] GatewayRecord gateway_record(const ProcessImage& image, std::uint32_t events_lost);

}  // namespace axisgate::dds
