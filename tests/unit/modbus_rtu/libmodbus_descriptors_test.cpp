// SPDX-License-Identifier: Apache-2.0
// Descriptors of 1024 and more, on which libmodbus's select() would abort the process: the link is down and says why.
#include <sys/resource.h>
#include <sys/select.h>

#include "tests/unit/modbus_rtu/libmodbus_link_stage.hpp"

namespace axisgate::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class LibmodbusDescriptors : public LibmodbusLinkStage {
 protected:
  void SetUp() override {
    rlimit limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
    ASSERT_GE(limit.rlim_max, FD_SETSIZE + 100U) << "this test needs more descriptors";
    limit.rlim_cur = std::max<rlim_t>(limit.rlim_cur, FD_SETSIZE + 100U);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  }
  void TearDown() override { free_low(); }
  /// As so many clients would.
  void take_all_low() {
    do {
      taken_.push_back(::open("/dev/null", O_RDONLY | O_CLOEXEC));
      ASSERT_GE(taken_.back(), 0);
    } while (taken_.back() < FD_SETSIZE);
  }
  void free_low() {
    for (const int descriptor : taken_) ::close(descriptor);
    taken_.clear();
  }
  auto says_why() {
    return AllOf(StartsWith("warning: " + folder / "device" + ": it got descriptor 10"),
                 HasSubstr("libmodbus serves none above 1023"), HasSubstr("LimitNOFILE"), HasSubstr("max_clients"));
  }
  std::vector<int> taken_;
  Pty pty;
};

TEST_F(LibmodbusDescriptors, of_1024_and_more_keep_the_link_down_until_lower_ones_are_free) {
  point(folder / "device", pty.device());
  take_all_low();
  start_at(folder / "device");
  ASSERT_TRUE(await([this] { return !log_lines.empty(); }));
  EXPECT_THAT(log_lines, ElementsAre(says_why()));
  for (int i = 0; i < 3; ++i) pass(1s);
  EXPECT_TRUE(diary.told.empty());
  free_low();
  EXPECT_TRUE(await([this] {
    pass(1s);
    return diary.up();
  }));
}

TEST_F(LibmodbusDescriptors, taken_by_clients_while_the_line_was_pulled_do_not_end_the_process) {
  auto first = std::make_unique<Pty>();
  point(folder / "device", first->device());
  open_at(folder / "device");
  std::filesystem::remove(folder / "device");
  first.reset();
  ASSERT_TRUE(await([this] { return diary.down(); }));
  take_all_low();
  point(folder / "device", pty.device());
  ASSERT_TRUE(await([this] {
    pass(100ms);
    return log_lines.size() > 1 && log_lines.back().find("descriptor") != std::string::npos;
  }));
  EXPECT_THAT(log_lines.back(), says_why());
  free_low();
  EXPECT_TRUE(await([this] {
    pass(1s);
    return diary.up();
  }));
  ask(pty);
}

}  // namespace
}  // namespace axisgate::test
