// SPDX-License-Identifier: Apache-2.0
// The descriptor rule as a table: limits and what the configuration asks in, plan out.
#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace axisgate::modbus_tcp {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// One listener and one bus: a reserve of 64 + 4 + 1.
DescriptorNeeds needs(std::uint32_t clients) { return {.clients = clients, .listeners = 1, .buses = 1}; }

struct Row {
  DescriptorLimits limits;
  std::uint32_t clients;
  std::uint64_t soft_limit;
  bool move_up;
  std::uint32_t max_clients;
};

void PrintTo(const Row& row, std::ostream* out) {
  *out << "soft " << row.limits.soft << ", hard " << row.limits.hard << ", " << row.clients << " clients";
}

class Plan : public ::testing::TestWithParam<Row> {};

TEST_P(Plan, RaisesNoMoreThanIsNeededAndServesWhatFits) {
  const Row& row = GetParam();
  const DescriptorPlan plan = plan_descriptors(row.limits, needs(row.clients));
  EXPECT_EQ(plan.soft_limit, row.soft_limit);
  EXPECT_EQ(plan.move_up, row.move_up);
  EXPECT_EQ(plan.max_clients, row.max_clients);
  EXPECT_EQ(plan.limited(), row.max_clients < row.clients);
  EXPECT_EQ(text(plan).empty(), !plan.limited());
}

/// Whatever the numbers: clients never reach into what belongs to ports, and none is let in for whom there is no room.
TEST_P(Plan, LeavesSerialPortsTheirNumbers) {
  const Row& row = GetParam();
  const DescriptorPlan plan = plan_descriptors(row.limits, needs(row.clients));
  EXPECT_GE(plan.soft_limit, row.limits.soft);
  EXPECT_LE(plan.soft_limit, row.limits.hard);
  if (plan.move_up) {
    EXPECT_LE(kSelectLimit + plan.max_clients, plan.soft_limit);
  } else if (plan.max_clients > 0) {
    EXPECT_LE(plan.needs.reserve() + plan.max_clients, kSelectLimit);
  }
}

INSTANTIATE_TEST_SUITE_P(Hard256, Plan,
                         ::testing::Values(Row{{256, 256}, 0, 256, false, 0}, Row{{256, 256}, 10, 256, false, 10},
                                           Row{{256, 256}, 187, 256, false, 187}, Row{{256, 256}, 188, 256, false, 187},
                                           Row{{256, 256}, 1000, 256, false, 187},
                                           Row{{128, 256}, 5000, 256, false, 187}));
INSTANTIATE_TEST_SUITE_P(Hard1024, Plan,
                         ::testing::Values(Row{{1024, 1024}, 0, 1024, false, 0}, Row{{1024, 1024}, 10, 1024, false, 10},
                                           Row{{256, 1024}, 955, 1024, false, 955},
                                           Row{{1024, 1024}, 1000, 1024, false, 955},
                                           Row{{1024, 1024}, 5000, 1024, false, 955}));
INSTANTIATE_TEST_SUITE_P(Hard4096, Plan,
                         ::testing::Values(Row{{1024, 4096}, 0, 1093, true, 0}, Row{{1024, 4096}, 10, 1103, true, 10},
                                           Row{{1024, 4096}, 1000, 2093, true, 1000},
                                           Row{{4096, 4096}, 1000, 4096, true, 1000},
                                           Row{{1024, 4096}, 3072, 4096, true, 3072},
                                           Row{{1024, 4096}, 5000, 4096, true, 3072}));
INSTANTIATE_TEST_SUITE_P(Hard524288, Plan,
                         ::testing::Values(Row{{1024, 524288}, 10, 1103, true, 10},
                                           Row{{1024, 524288}, 1000, 2093, true, 1000},
                                           Row{{1024, 524288}, 5000, 6093, true, 5000}));
INSTANTIATE_TEST_SUITE_P(Unlimited, Plan,
                         ::testing::Values(Row{{1024, kUnlimited}, 10, 1103, true, 10},
                                           Row{{1024, kUnlimited}, 5000, 6093, true, 5000},
                                           Row{{kUnlimited, kUnlimited}, 5000, kUnlimited, true, 5000}));
INSTANTIATE_TEST_SUITE_P(JustAbove1024, Plan,
                         ::testing::Values(Row{{1024, 1100}, 76, 1100, true, 76},      // all fit above
                                           Row{{1024, 1100}, 77, 1100, false, 77},     // more fit below
                                           Row{{1024, 1100}, 1000, 1100, false, 955},  //
                                           Row{{1024, 1979}, 1000, 1979, true, 955},   // as many either way
                                           Row{{1024, 1980}, 1000, 1980, true, 956}));
INSTANTIATE_TEST_SUITE_P(TooLittleForAnyClient, Plan,
                         ::testing::Values(Row{{69, 69}, 10, 69, false, 0}, Row{{70, 70}, 10, 70, false, 1},
                                           Row{{0, 0}, 10, 0, false, 0}));

TEST(DescriptorNeeds, KeepRoomForEachBusAndListener) {
  const DescriptorLimits limits{1024, 1024};
  const DescriptorPlan few = plan_descriptors(limits, {.clients = 1000, .listeners = 1, .buses = 1});
  const DescriptorPlan most = plan_descriptors(limits, {.clients = 1000, .listeners = 16, .buses = 100});
  EXPECT_EQ(few.max_clients - most.max_clients, 15U + 99U * kDescriptorsPerBus);
  EXPECT_EQ(most.max_clients, 1024U - 64U - 400U - 16U);
}

TEST(DescriptorPlanText, SaysHowManyAreServedWhyAndWhatToChange) {
  const std::string told = text(plan_descriptors({256, 1024}, needs(1500)));
  EXPECT_EQ(told,
            "at most 955 clients at once, though max_clients allows 1500: this process may have 1024 files open, and "
            "descriptors below 1024 are kept for serial ports; raise its hard limit to 2593 (LimitNOFILE of a service, "
            "ulimit -Hn of a shell) or lower max_clients");
}

TEST(DescriptorPlanText, NamesALimitUnderWhichNothingIsLimited) {
  for (const std::uint64_t hard : {64U, 1024U, 1100U, 2000U}) {
    const DescriptorPlan plan = plan_descriptors({hard, hard}, needs(1500));
    EXPECT_THAT(text(plan), AllOf(HasSubstr("at most " + std::to_string(plan.max_clients) + " clients"),
                                  HasSubstr("hard limit to " + std::to_string(plan.needs.limit()))));
    EXPECT_EQ(text(plan_descriptors({hard, plan.needs.limit()}, needs(1500))), "");
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp
