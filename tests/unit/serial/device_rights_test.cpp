// SPDX-License-Identifier: Apache-2.0
#include "adapters/serial/device_rights.hpp"

#include <gmock/gmock.h>

namespace axisgate::serial {
namespace {

using ::testing::HasSubstr;

TEST(DeviceRights, WhoIsNotInTheGroupOfTheDeviceIsToldHowToJoinIt) {
  EXPECT_EQ(rights_remedy({"dialout", true, "anna", false}),
            ": it belongs to group dialout, and user anna is not in it: usermod -aG dialout anna, then log in again, "
            "or restart the service");
}

TEST(DeviceRights, WhoHasJoinedItSinceThisLoginIsToldToLogInAgain) {
  EXPECT_THAT(rights_remedy({"dialout", true, "anna", true}), HasSubstr("log in again"));
  EXPECT_THAT(rights_remedy({"dialout", true, "anna", true}), ::testing::Not(HasSubstr("usermod")));
}

TEST(DeviceRights, WhereTheGroupMayNotEitherAUdevRuleIsNamed) {
  EXPECT_THAT(rights_remedy({"root", false, "anna", false}),
              AllOf(HasSubstr("it belongs to group root, which may not read and write it either"),
                    HasSubstr("GROUP=\"dialout\", MODE=\"0660\"")));
}

TEST(DeviceRights, OfAPathThatIsGoneNothingIsSaid) { EXPECT_EQ(rights_remedy_of("/nowhere/ttyUSB0"), ""); }

}  // namespace
}  // namespace axisgate::serial
