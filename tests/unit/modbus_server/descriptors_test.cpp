#include "gateway/upstream/modbus_tcp/descriptors.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace axisgate::modbus_tcp {
namespace {

TEST(DescriptorRule, WhereTheLimitAllowsClientsLiveAbove1023) {
  const DescriptorRule rule = descriptor_rule(20'000);
  EXPECT_TRUE(rule.move_up);
  EXPECT_EQ(rule.max_clients, 20'000U - 1024U);
}

TEST(DescriptorRule, WhereItForbidsThatClientsAreFewEnoughThatAllStaysBelow1024) {
  const DescriptorRule rule = descriptor_rule(1024);
  EXPECT_FALSE(rule.move_up);
  EXPECT_EQ(rule.max_clients, 1024U - kOwnDescriptors);
  EXPECT_EQ(descriptor_rule(256).max_clients, 256U - kOwnDescriptors);
  EXPECT_EQ(descriptor_rule(64).max_clients, 0U);
}

TEST(DescriptorRule, ALimitJustAbove1024ServesMoreClientsBelowIt) {
  const DescriptorRule rule = descriptor_rule(1100);
  EXPECT_FALSE(rule.move_up);
  EXPECT_EQ(rule.max_clients, 1024U - kOwnDescriptors);
}

TEST(Descriptors, TheSoftLimitIsRaisedToTheHardOne) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit lowered = before;
  lowered.rlim_cur = 512;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &lowered), 0);
  EXPECT_EQ(descriptor_limit(), 512U);
  EXPECT_EQ(raise_descriptor_limit(), before.rlim_max);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(Descriptors, AMovedDescriptorIsThere1024AndAboveAndItsOldNumberIsFree) {
  if (raise_descriptor_limit() <= kSelectLimit) {
    ASSERT_FALSE(descriptor_rule(descriptor_limit()).move_up) << "nothing is moved on this system";
    return;
  }
  const int low = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(low, 0);
  const int high = moved_up(low);
  EXPECT_GE(high, static_cast<int>(kSelectLimit));
  EXPECT_EQ(::fcntl(low, F_GETFD), -1);
  EXPECT_EQ(::fcntl(high, F_GETFD), FD_CLOEXEC);
  ::close(high);
}

}  // namespace
}  // namespace axisgate::modbus_tcp
