// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/access.hpp"

#include <gtest/gtest.h>

namespace axisgate::modbus_tcp {
namespace {

Address v4(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
  return {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, a, b, c, d};
}
constexpr Address kLoopback6{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
constexpr Address kLocal6{0xFD, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7};

AllowEntry entry(const Address& network, std::uint8_t prefix, Role role) { return {network, prefix, role, 0}; }

ListenerSettings with_allow(std::vector<AllowEntry> allow) {
  ListenerSettings settings;
  settings.has_allow = true;
  settings.allow = std::move(allow);
  return settings;
}

TEST(Access, AddressesAreWrittenAsPeopleWriteThem) {
  EXPECT_EQ(text(v4(192, 168, 1, 7)), "192.168.1.7");
  EXPECT_EQ(text(kLoopback6), "::1");
  EXPECT_EQ(text(kLocal6), "fd00::7");
}

TEST(Access, WithoutAllowLoopbackIsEngineerAndEverybodyElseViewer) {
  const ListenerSettings settings;
  EXPECT_EQ(role_of(settings, v4(127, 0, 0, 1)), Role::engineer);
  EXPECT_EQ(role_of(settings, v4(127, 8, 9, 10)), Role::engineer);
  EXPECT_EQ(role_of(settings, kLoopback6), Role::engineer);
  EXPECT_EQ(role_of(settings, v4(192, 168, 1, 7)), Role::viewer);
  EXPECT_EQ(role_of(settings, kLocal6), Role::viewer);
  EXPECT_EQ(role_of(settings, Address{}), Role::viewer) << "an address of zeros is no loopback";
  EXPECT_EQ(rank_of(settings, v4(127, 0, 0, 1)), 0);
}

TEST(Access, WithAllowAnAddressItDoesNotNameHasNoRoleLoopbackIncluded) {
  const auto settings = with_allow({entry(v4(192, 168, 1, 0), 120, Role::operator_)});
  EXPECT_EQ(role_of(settings, v4(192, 168, 1, 0)), Role::operator_);
  EXPECT_EQ(role_of(settings, v4(192, 168, 1, 255)), Role::operator_);
  EXPECT_EQ(role_of(settings, v4(192, 168, 2, 0)), Role::none);
  EXPECT_EQ(role_of(settings, v4(127, 0, 0, 1)), Role::none);
  EXPECT_EQ(role_of(with_allow({}), v4(127, 0, 0, 1)), Role::none) << "an empty list names nobody";
}

TEST(Access, PrefixesThatEndInsideAByteCountBitByBit) {
  const auto settings = with_allow({entry(v4(10, 0, 0, 160), 123, Role::viewer)});  // 10.0.0.160/27
  EXPECT_EQ(role_of(settings, v4(10, 0, 0, 159)), Role::none);
  EXPECT_EQ(role_of(settings, v4(10, 0, 0, 160)), Role::viewer);
  EXPECT_EQ(role_of(settings, v4(10, 0, 0, 191)), Role::viewer);
  EXPECT_EQ(role_of(settings, v4(10, 0, 0, 192)), Role::none);
}

TEST(Access, AnIpv4NetworkOfAllAddressesHoldsNoIpv6Address) {
  const auto settings = with_allow({entry(v4(0, 0, 0, 0), 96, Role::viewer)});
  EXPECT_EQ(role_of(settings, v4(8, 8, 8, 8)), Role::viewer);
  EXPECT_EQ(role_of(settings, kLocal6), Role::none);
  EXPECT_EQ(role_of(with_allow({entry(Address{}, 0, Role::viewer)}), v4(8, 8, 8, 8)), Role::viewer)
      << "::/0 is everybody";
}

TEST(Access, TheMostSpecificEntryDecidesWhateverTheOrder) {
  const AllowEntry wide = entry(v4(192, 168, 0, 0), 112, Role::viewer);
  const AllowEntry narrow{v4(192, 168, 1, 0), 120, Role::operator_, 9};
  const AllowEntry host{v4(192, 168, 1, 7), 128, Role::engineer, 2};
  for (const auto& order :
       {std::vector{wide, narrow, host}, std::vector{host, narrow, wide}, std::vector{narrow, host, wide}}) {
    const auto settings = with_allow(order);
    EXPECT_EQ(role_of(settings, v4(192, 168, 9, 9)), Role::viewer);
    EXPECT_EQ(role_of(settings, v4(192, 168, 1, 9)), Role::operator_);
    EXPECT_EQ(role_of(settings, v4(192, 168, 1, 7)), Role::engineer);
    EXPECT_EQ(rank_of(settings, v4(192, 168, 1, 7)), 2);
    EXPECT_EQ(rank_of(settings, v4(192, 168, 1, 8)), 9);
    EXPECT_EQ(rank_of(settings, v4(10, 0, 0, 1)), 0) << "nobody";
  }
}

constexpr std::uint32_t kManyDescriptors = 100'000;

TEST(ClientCounts, ReleasedRoomIsRoomAgain) {
  ListenerSettings settings;
  settings.max_clients = 2;
  ClientCounts counts;
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 2), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 3), Role::viewer, kManyDescriptors), ConnectionVerdict::listener_full);
  counts.release(v4(1, 1, 1, 1));
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 3), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.total(), 2U);
}

TEST(ClientCounts, OneAddressCannotTakeAllRoom) {
  ListenerSettings settings;
  settings.max_clients_per_address = 3;
  ClientCounts counts;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  }
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, kManyDescriptors), ConnectionVerdict::address_full);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 2), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
}

TEST(ClientCounts, ZeroPerAddressIsNoLimit) {
  ListenerSettings settings;
  settings.max_clients_per_address = 0;
  ClientCounts counts;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  }
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, kManyDescriptors), ConnectionVerdict::listener_full);
}

TEST(ClientCounts, ViewersLeaveATenthToOperatorsWhereAllowNamesSome) {
  auto settings = with_allow({entry(Address{}, 0, Role::viewer), entry(v4(1, 1, 1, 1), 128, Role::operator_)});
  settings.max_clients = 20;
  ClientCounts counts;
  for (std::uint8_t i = 0; i < 18; ++i) {
    ASSERT_EQ(counts.admit(settings, v4(2, 2, 2, i), Role::viewer, kManyDescriptors), ConnectionVerdict::admitted);
  }
  EXPECT_EQ(counts.admit(settings, v4(2, 2, 2, 99), Role::viewer, kManyDescriptors),
            ConnectionVerdict::kept_for_operators);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::operator_, kManyDescriptors), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::operator_, kManyDescriptors), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::operator_, kManyDescriptors),
            ConnectionVerdict::listener_full);
}

TEST(ClientCounts, NothingIsKeptWhereNobodyIsNamed) {
  EXPECT_EQ(kept_for_operators(ListenerSettings{}), 0U);
  EXPECT_EQ(kept_for_operators(with_allow({entry(Address{}, 0, Role::viewer)})), 0U);
}

TEST(ClientCounts, TheDescriptorRuleLimitsWhateverTheSettingsSay) {
  const ListenerSettings settings;
  ClientCounts counts;
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 1), Role::viewer, 1), ConnectionVerdict::admitted);
  EXPECT_EQ(counts.admit(settings, v4(1, 1, 1, 2), Role::viewer, 1), ConnectionVerdict::no_descriptor);
}

TEST(ClientCounts, RefusalsNameTheLimitAndItsValue) {
  ListenerSettings settings = with_allow({entry(v4(1, 1, 1, 1), 128, Role::operator_)});
  EXPECT_EQ(text(ConnectionVerdict::listener_full, settings), "max_clients (1000) is reached");
  EXPECT_EQ(text(ConnectionVerdict::address_full, settings), "max_clients_per_address (64) is reached");
  EXPECT_EQ(text(ConnectionVerdict::kept_for_operators, settings),
            "the last 100 of max_clients (1000) are kept for operators and engineers");
}

TEST(LineLimit, LetsOneLineThroughPerIntervalAndCountsTheOthers) {
  LineLimit limit(std::chrono::minutes(1));
  const Instant start{};
  EXPECT_EQ(limit.admit(start), 0U);
  EXPECT_FALSE(limit.admit(start));
  EXPECT_FALSE(limit.admit(start + std::chrono::seconds(59)));
  EXPECT_EQ(limit.admit(start + std::chrono::seconds(60)), 2U);
  EXPECT_FALSE(limit.admit(start + std::chrono::seconds(61)));
  EXPECT_EQ(limit.admit(start + std::chrono::seconds(200)), 1U);
}

}  // namespace
}  // namespace axisgate::modbus_tcp
