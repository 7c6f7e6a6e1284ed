// SPDX-License-Identifier: Apache-2.0
// What a DDS writer may do: the role of its certificate where DDS-Security tells it, else that of all others (design
// 4). Promises that nobody has a certificate's role whose participant does not carry its subject. Never proves that
// itself: axisgate-dds takes no `roles` without authentication.
#pragma once

#include <map>

#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class Identities {
 public:
  /// `settings` outlives it.
  explicit Identities(const DdsSettings& settings) : settings_(settings) {}

  /// axisgate-dds has read the certificate.
  void on_record(const IdentityRecord& record) {
    if (record.number < settings_.roles.size()) roles_[identity_of(record.guid)] = settings_.roles[record.number].role;
  }
  [[nodiscard]] Role role_of(const Guid& writer) const {
    const auto found = roles_.find(identity_of(writer));
    return found == roles_.end() ? settings_.role : found->second;
  }

 private:
  const DdsSettings& settings_;
  std::map<Identity, Role> roles_;
};

}  // namespace axisgate::dds
