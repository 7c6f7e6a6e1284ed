// 50 seeds of 60 virtual seconds, each followed by a quiet tail in which everything must come back. Replay one seed
// with `simulate --seed N`.
#include <gtest/gtest.h>

#include "tests/sim/world.hpp"

namespace axisgate::test {
namespace {

class Seeds : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Seeds, KeepEveryInvariantAndComeBack) {
  World world(GetParam());
  world.run(std::chrono::seconds(60));
  world.recover();
  for (const std::string& violation : world.violations()) ADD_FAILURE() << "seed " << GetParam() << " " << violation;
  // A run in which nothing happened proves nothing.
  EXPECT_GT(world.asked().replies, 500U) << world.summary();
}
INSTANTIATE_TEST_SUITE_P(Simulation, Seeds, testing::Range<std::uint64_t>(1, 51));

TEST(Simulation, GivesTheSameHashForTheSameSeedAndAnotherForAnother) {
  const auto hash = [](std::uint64_t seed) {
    World world(seed);
    world.run(std::chrono::seconds(10));
    return world.hash();
  };
  EXPECT_EQ(hash(7), hash(7));
  EXPECT_NE(hash(7), hash(8));
}

}  // namespace
}  // namespace axisgate::test
