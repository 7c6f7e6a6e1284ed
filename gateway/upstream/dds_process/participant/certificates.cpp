// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/participant/certificates.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::dds {
namespace {

constexpr std::string_view kFile = "file://";

std::string property(const fastdds::DomainParticipantQos& qos, const std::string& name) {
  for (const auto& each : qos.properties().properties())
    if (each.name() == name) return each.value();
  return {};
}

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The text of the only element of this name, or of each of them where all have the same; else empty.
std::string element(const std::string& xml, const std::string& name) {
  const std::string begin = "<" + name + ">", end = "</" + name + ">";
  std::string found;
  for (std::size_t at = 0; (at = xml.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    std::string text = xml.substr(at, xml.find(end, at) - at);
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
    if (!found.empty() && text != found) return {};
    found = text;
  }
  return found;
}

}  // namespace

Guid guid_of_certificate(const std::string& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "r"), std::fclose);
  const std::unique_ptr<X509, void (*)(X509*)> certificate(
      opened ? PEM_read_X509(opened.get(), nullptr, nullptr, nullptr) : nullptr, X509_free);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (!certificate ||
      X509_NAME_digest(X509_get_subject_name(certificate.get()), EVP_sha256(), digest.data(), &size) != 1)
    throw program::StartError(link::kExitCannotServe,
                              fmt::format("--certificate {}: no certificate in PEM can be read from it", file));
  // One bit that is 1, then 47 of the digest.
  Guid out{};
  unsigned carried = 1;
  for (std::size_t i = 0; i < kIdentityBytes; ++i) {
    out[i] = static_cast<std::uint8_t>(carried << 7U | digest[i] >> 1U);
    carried = digest[i] & 1U;
  }
  return out;
}

void require_authentication(const fastdds::DomainParticipantQos& qos) {
  const auto refuse = [](const std::string& why) {
    throw program::StartError(link::kExitCannotServe, "--certificate: whose a writer is must be proven, and " + why);
  };
  if (property(qos, "dds.sec.auth.plugin") != "builtin.PKI-DH" ||
      property(qos, "dds.sec.access.plugin") != "builtin.Access-Permissions" ||
      property(qos, "dds.sec.crypto.plugin") != "builtin.AES-GCM-GMAC") {
    refuse("the participant of the QoS file has not all plugins of DDS-Security (PKI-DH, Access-Permissions, AES-GCM)");
  }
  std::string path = property(qos, "dds.sec.access.builtin.Access-Permissions.governance");
  if (path.starts_with(kFile)) path.erase(0, kFile.size());
  const std::string governance = read_file(path);
  if (element(governance, "allow_unauthenticated_participants") != "false")
    refuse(fmt::format("{} does not say allow_unauthenticated_participants false in every rule", path));
  const std::string protection = element(governance, "rtps_protection_kind");
  if (protection.empty() || protection == "NONE")
    refuse(fmt::format("{} does not protect the messages (rtps_protection_kind) alike in every rule", path));
}

}  // namespace axisgate::dds
