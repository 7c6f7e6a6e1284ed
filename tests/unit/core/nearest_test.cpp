// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/nearest.hpp"

#include <gmock/gmock.h>

namespace axisgate {
namespace {

TEST(Nearest, AMistypedWordIsTheKnownOneThatFewestCharactersSeparateFromIt) {
  EXPECT_EQ(nearest("velocty", {"statusword", "velocity"}), "velocity");
  EXPECT_EQ(nearest("kinco-jf", {"kinco-md", "kinco-jd"}), "kinco-jd");
  EXPECT_EQ(nearest("--interfal", {"--seconds", "--interval"}), "--interval");
}

TEST(Nearest, TwoCharactersInEachOthersPlaceAreOneMistake) {
  EXPECT_EQ(nearest("chekc", {"check"}), "check");
  EXPECT_EQ(nearest("rnu", {"run"}), "run");
}

TEST(Nearest, AWordFarFromEveryKnownOneIsNone) {
  EXPECT_EQ(nearest("velocity", {"statusword", "mode"}), std::nullopt);
  EXPECT_EQ(nearest("x", {"run", "map"}), std::nullopt);
  EXPECT_EQ(nearest("abc", {"run", "map", "top"}), std::nullopt) << "of three characters two are too many";
  EXPECT_EQ(nearest("", {"run"}), std::nullopt);
  EXPECT_EQ(nearest("run", {}), std::nullopt);
  EXPECT_EQ(nearest(std::string(100'000, 'a'), {std::string(100'000, 'a') + "b"}), std::nullopt);
}

TEST(Nearest, OfTwoThatAreEquallyNearTheFirstIsNamed) { EXPECT_EQ(nearest("scam", {"scan", "scat"}), "scan"); }

TEST(Nearest, TheEndOfAMessageNamesItOrSaysNothing) {
  EXPECT_EQ(did_you_mean("enabel", {"enable", "stop"}), "; did you mean \"enable\"?");
  EXPECT_EQ(did_you_mean("banana", {"enable", "stop"}), "");
}

}  // namespace
}  // namespace axisgate
