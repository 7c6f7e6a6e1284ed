// SPDX-License-Identifier: Apache-2.0
// Whose GUIDs are those of a certificate's subject. DDS-Security (1.1, 9.3.3) makes the first bytes of a participant's
// GUID from the subject of its certificate, and each side of a handshake checks that of the other (Fast DDS 2.9.1
// does). Promises to refuse where a participant could be heard without such a handshake. Never reads a private key.
#pragma once

#include <string>

#include "gateway/upstream/dds_link/guid.hpp"
#include "gateway/upstream/dds_process/participant/participant.hpp"

namespace axisgate::dds {

/// A GUID whose first kIdentityBytes are those of the certificate in this PEM file.
[[nodiscard]] Guid guid_of_certificate(const std::string& file);
/// Nobody joins without a certificate, and no message counts that is not protected.
void require_authentication(const fastdds::DomainParticipantQos& qos);

}  // namespace axisgate::dds
