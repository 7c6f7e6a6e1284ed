// SPDX-License-Identifier: Apache-2.0
// Whose writers have the role of a certificate, and where axisgate-dds does not believe that anybody proves it.
#include "gateway/upstream/dds_process/participant/certificates.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::dds {
namespace {

using testing::HasSubstr;

/// Of CN=operator, as deploy/examples/dds/security/make makes it. It needs no key here, and may be out of date.
constexpr const char* kOperator = R"(-----BEGIN CERTIFICATE-----
MIIBIzCBygIUVsl/gTC47LxoGApgkxaR0zK20JkwCgYIKoZIzj0EAwIwFjEUMBIG
A1UEAwwLYXhpc2dhdGUgQ0EwHhcNMjYxMTI1MjIyMTA0WhcNMzYxMTIyMjIyMTA0
WjATMREwDwYDVQQDDAhvcGVyYXRvcjBZMBMGByqGSM49AgEGCCqGSM49AwEHA0IA
BCPvoUjkGYPkSnZ4ElLOIsAfqnAX42A8bFoWH1N2tCKz/avNvstgohNHdFZVF1Q+
Oahx+UBBekHrjZUKO+VNG2cwCgYIKoZIzj0EAwIDSAAwRQIhAIxjaQnvL3qgdt/7
n/ojBmj0vhV0ahpS8oegbbzssWeZAiBWMd9j2AzL1UhAnwfrLbbcSJ55XLhz7FRI
I8w7pqnbCQ==
-----END CERTIFICATE-----
)";

class WithAFile : public testing::Test {
 protected:
  ~WithAFile() override { std::remove(path_.c_str()); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  const std::string path_ = testing::TempDir() + "axisgate_certificates_" + std::to_string(getpid());
};

using Certificate = WithAFile;

TEST_F(Certificate, OfASubjectIsThatOfItsParticipants) {
  write(kOperator);
  // One bit that is 1, then 47 bits of the SHA-256 of 30 13 31 11 30 0F 06 03 55 04 03 0C 08 "operator".
  EXPECT_EQ(identity_of(guid_of_certificate(path_)), (Identity{0xF9, 0xD2, 0xA0, 0xCE, 0x57, 0xFB}));
}

TEST_F(Certificate, ThatCannotBeReadIsToldByItsFile) {
  for (const char* const text : {"", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n"}) {
    write(text);
    try {
      static_cast<void>(guid_of_certificate(path_));
      ADD_FAILURE() << "it was read";
    } catch (const program::StartError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--certificate " + path_ + ": no certificate"));
    }
  }
}

class Governance : public WithAFile {
 protected:
  Governance() {
    add("dds.sec.auth.plugin", "builtin.PKI-DH");
    add("dds.sec.access.plugin", "builtin.Access-Permissions");
    add("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
    add("dds.sec.access.builtin.Access-Permissions.governance", "file://" + path_);
  }
  void add(const std::string& name, const std::string& value) {
    qos_.properties().properties().emplace_back(name, value);
  }
  [[nodiscard]] std::string refused(const std::string& document) const {
    write(document);
    try {
      require_authentication(qos_);
      return "";
    } catch (const program::StartError& error) {
      return error.what();
    }
  }
  static std::string rule(const std::string& unauthenticated, const std::string& protection) {
    return "<allow_unauthenticated_participants> " + unauthenticated +
           "\r\n</allow_unauthenticated_participants>\n<rtps_protection_kind>" + protection +
           "</rtps_protection_kind>\n";
  }
  fastdds::DomainParticipantQos qos_;
};

TEST_F(Governance, ThatLetsNobodyInWithoutACertificateIsTaken) {
  EXPECT_EQ(refused(rule("false", "ENCRYPT")), "");
  EXPECT_EQ(refused(rule("false", "SIGN") + rule("false", "SIGN")), "");
}

TEST_F(Governance, ThatLetsAnybodyInIsRefused) {
  for (const std::string& document :
       {rule("true", "ENCRYPT"), rule("false", "ENCRYPT") + rule("true", "ENCRYPT"), std::string()})
    EXPECT_THAT(refused(document), HasSubstr("allow_unauthenticated_participants false"));
  for (const std::string& document : {rule("false", "NONE"), rule("false", "SIGN") + rule("false", "NONE")})
    EXPECT_THAT(refused(document), HasSubstr("does not protect the messages"));
}

TEST_F(Governance, WithoutAllPluginsIsRefused) {
  for (auto& property : qos_.properties().properties()) {
    if (!property.name().starts_with("dds.sec.")) continue;  // the library has some of its own
    const std::string value = property.value();
    property.value("");
    EXPECT_THAT(refused(rule("false", "ENCRYPT")), HasSubstr("whose a writer is must be proven")) << property.name();
    property.value(value);
  }
  qos_.properties().properties().clear();
  EXPECT_THAT(refused(rule("false", "ENCRYPT")), HasSubstr("plugins of DDS-Security"));
}

}  // namespace
}  // namespace axisgate::dds
