// SPDX-License-Identifier: Apache-2.0
// Posted writes ("writes": "posted"): the answer comes after the checks, and register 25 tells of all that comes to
// nothing later.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kHostOfScanner = 40;
constexpr std::int64_t kUnsuitable = 9, kCarriedOut = 2;

modbus_tcp::ListenerSettings of_scanners() {
  modbus_tcp::ListenerSettings settings;
  settings.posted_writes = true;
  return settings;
}

class Posted : public testing::TestWithParam<Subject> {
 protected:
  Posted() { plant_.ready(); }
  Plant plant_{GetParam()};
  std::unique_ptr<Client> scanner_ = plant_.connection_from(kHostOfScanner, of_scanners());
};

TEST_P(Posted, TellOfARelativeMoveThatCameWhileTheAxisMoved) {
  ASSERT_EQ(scanner_->row(row::target_position, kFar), kOk);
  ASSERT_EQ(scanner_->command(kMove), kOk);
  ASSERT_TRUE(plant_.turns_within(1s));
  plant_.run(300ms);
  EXPECT_EQ(scanner_->result(), kCarriedOut);
  ASSERT_EQ(scanner_->command(kRelative), kOk);
  plant_.run(300ms);
  EXPECT_EQ(scanner_->result(), kUnsuitable);
  EXPECT_NEAR(static_cast<double>(plant_.comes_to_rest_at()), kFar, kClose);
}

TEST_P(Posted, AreToldAsOthersAreRefused) {
  ASSERT_EQ(plant_.a.row(row::target_position, kFar), kOk);
  ASSERT_EQ(plant_.a.command(kMove), kOk);
  ASSERT_TRUE(plant_.turns_within(1s));
  EXPECT_EQ(plant_.a.command(kRelative), kNotNow);
  EXPECT_EQ(plant_.a.result(), kUnsuitable);
}

INSTANTIATE_TEST_SUITE_P(Every, Posted, testing::ValuesIn(subjects(has_positions)), named);

}  // namespace
}  // namespace axisgate::test::obey
