// What `--line` understands, and what it says to what it does not.
#include "tests/axisgate_sim/line_spec.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace axisgate::simulated {
namespace {

TEST(LineSpec, NamesThePathTheLineAndItsDrives) {
  const LineSpec spec = parse_line_spec("/tmp/a:b/table:md@1,jd@2+fresh+home=-10..20", {});
  EXPECT_EQ(spec.path, "/tmp/a:b/table");
  EXPECT_EQ(spec.name, "table");
  ASSERT_EQ(spec.drives.size(), 2U);
  EXPECT_EQ(spec.drives[0].type, KincoType::md);
  EXPECT_FALSE(spec.drives[0].factory_fresh);
  EXPECT_EQ(spec.drives[1].station, 2);
  EXPECT_TRUE(spec.drives[1].factory_fresh);
  EXPECT_EQ(spec.drives[1].mechanics.home_from, -10);
  EXPECT_EQ(spec.drives[1].mechanics.home_to, 20);
  EXPECT_EQ(describe(spec.drives), "md@1,jd@2");
}

TEST(LineSpec, SaysWhatToChange) {
  const auto message = [](const char* text) -> std::string {
    try {
      (void)parse_line_spec(text, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message("/tmp/lift"), HasSubstr("PATH:DRIVES"));
  EXPECT_THAT(message("/tmp/:jd@1"), HasSubstr("name the link"));
  EXPECT_THAT(message("/tmp/x:abc@1"), HasSubstr("type jd or md"));
  EXPECT_THAT(message("/tmp/x:jd@0"), HasSubstr("1 to 127"));
  EXPECT_THAT(message("/tmp/x:jd@1,md@1"), HasSubstr("already on the line"));
  EXPECT_THAT(message("/tmp/x:jd@1+old"), HasSubstr("use fresh"));
  EXPECT_THAT(message("/tmp/x:jd@1+home=5"), HasSubstr("FROM..TO"));
}

}  // namespace
}  // namespace axisgate::simulated
