// SPDX-License-Identifier: Apache-2.0
// An enable whose acknowledgement was lost is told 0x0B, outcome unknown: it leaves no torque behind that its client
// does not know of, and is not taken back from a client that asks again.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kUnknownOutcome = 0x0B;

/// An enable whose replies are lost from one of its exchanges on, one after another; those that end with 0x0B. Two
/// lost ones make no drive offline.
class LostEnable : public testing::TestWithParam<Subject> {
 protected:
  void each(const std::function<void(Plant&)>& then) {
    constexpr std::size_t kExchanges = 14;
    for (std::uint64_t lost = 1; lost <= 2; ++lost) {
      for (std::size_t at = 0; at < kExchanges; ++at) {
        SCOPED_TRACE(std::to_string(lost) + " lost after " + std::to_string(at));
        PlantOptions options;
        options.listener.reply_deadline = 200ms;  // over before what was lost can be read back
        Plant plant(GetParam(), options);
        plant.ready_but_disabled();
        const std::uint64_t before = plant.requests_heard();
        const RequestNumber enable = plant.a.begin(one(row::command, kEnable));
        const auto answered = [&] { return plant.a.answer_of(enable).has_value(); };
        plant.stage.run_until([&] { return answered() || plant.requests_heard() >= before + at; });
        if (answered()) break;
        plant.strike(Strike::lose_reply, lost);
        ASSERT_TRUE(plant.stage.run_until(answered));
        if (*plant.a.answer_of(enable) == kUnknownOutcome) then(plant);
      }
    }
  }
};

TEST_P(LostEnable, LeavesNoTorqueBehind) {
  each([](Plant& plant) {
    plant.run(4s);
    EXPECT_FALSE(*plant.motor().enabled);
    EXPECT_EQ(plant.a.word(shown::axis_state), 0);
    EXPECT_EQ(plant.a.command(0), kOk);
    EXPECT_EQ(plant.a.command(kEnable), kOk) << "nothing stands in the way of another one";
  });
}

TEST_P(LostEnable, IsNotTakenBackFromWhoAsksAgain) {
  each([](Plant& plant) {
    EXPECT_EQ(plant.a.command(0), kOk);
    if (plant.a.command(kEnable) != kOk) return;  // nobody knows again
    plant.run(8s);
    EXPECT_TRUE(*plant.motor().enabled);
  });
}

INSTANTIATE_TEST_SUITE_P(Every, LostEnable,
                         testing::ValuesIn(subjects([](Subject s) { return s != Subject::id286pro; })), named);

}  // namespace
}  // namespace axisgate::test::obey
