// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_endpoint.hpp"

#include <gmock/gmock.h>

namespace axisgate::config {
namespace {

TEST(Endpoint, TakesNumericAddressesAndAPort) {
  const auto v4 = parse_endpoint("192.168.1.7:502");
  ASSERT_TRUE(v4);
  EXPECT_EQ(v4->host, "192.168.1.7");
  EXPECT_EQ(v4->port, 502);
  const auto v6 = parse_endpoint("[fd00::1]:65535");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->host, "fd00::1");
  EXPECT_EQ(v6->port, 65535);
}

TEST(Endpoint, RefusesEverythingElse) {
  for (const char* wrong :
       {"", ":", "1502", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:15 02",
        "127.0.0.1:1502x", "gateway.local:1502", "localhost:1502", "::1:1502", "[::1]", "[::1]1502", "[127.0.0.1]:1502",
        "127.0.0:1502", "[]:1502", " 127.0.0.1:1502"}) {
    EXPECT_FALSE(parse_endpoint(wrong)) << wrong;
  }
}

TEST(Endpoint, KnowsAnyAndLoopback) {
  EXPECT_TRUE(is_any_address("0.0.0.0"));
  EXPECT_TRUE(is_any_address("::"));
  EXPECT_TRUE(is_any_address("0::0"));
  EXPECT_FALSE(is_any_address("0.0.0.1"));
  EXPECT_FALSE(is_any_address("::ffff:0.0.0.1"));
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("127.1.2.3"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_FALSE(is_loopback("::"));
  EXPECT_FALSE(is_loopback("nonsense"));
}

TEST(Network, AHostIsANetworkOfOne) {
  const auto v4 = parse_network("10.0.0.1");
  ASSERT_TRUE(v4);
  EXPECT_EQ(v4->prefix, 128);
  EXPECT_EQ(v4->address, (modbus_tcp::Address{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 10, 0, 0, 1}));
  const auto v6 = parse_network("fd00::1");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->prefix, 128);
  EXPECT_EQ(v6->address[0], 0xFD);
  EXPECT_EQ(v6->address[15], 1);
}

TEST(Network, APrefixOfIpv4CountsBehindTheMappedOne) {
  const auto network = parse_network("192.168.0.0/16");
  ASSERT_TRUE(network);
  EXPECT_EQ(network->prefix, 112);
  EXPECT_TRUE(network->host_bits_clear);
  EXPECT_EQ(parse_network("0.0.0.0/0")->prefix, 96);
  EXPECT_EQ(parse_network("::/0")->prefix, 0);
  EXPECT_EQ(parse_network("fd00::/8")->prefix, 8);
}

TEST(Network, SeesAddressBitsBehindThePrefix) {
  EXPECT_FALSE(parse_network("192.168.1.7/24")->host_bits_clear);
  EXPECT_TRUE(parse_network("192.168.1.128/25")->host_bits_clear);
  EXPECT_FALSE(parse_network("fd00::1/8")->host_bits_clear);
}

TEST(Network, RefusesEverythingElse) {
  for (const char* wrong : {"", "/", "192.168.1.0/", "192.168.1.0/33", "192.168.1/24", "fd00::/129", "plc.local",
                            "10.0.0.0/8/8", "10.0.0.0/-1"}) {
    EXPECT_FALSE(parse_network(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace axisgate::config
