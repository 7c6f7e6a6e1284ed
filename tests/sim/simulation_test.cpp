// 12 seeds of 60 virtual seconds, each followed by a quiet tail in which everything must come back; tests/soak/run
// --seeds takes as many as it is told. Replay one seed with `simulate --seed N`.
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
// Of the first 50: each mixture of lines, each wiring of Kinco drives, and those with the most late replies, bad frames
// and timeouts.
INSTANTIATE_TEST_SUITE_P(Simulation, Seeds, testing::Values(1, 3, 5, 7, 9, 10, 12, 20, 23, 37, 43, 45));

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
