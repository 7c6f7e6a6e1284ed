// SPDX-License-Identifier: Apache-2.0
// When a device is tried again: what is seen of its path, and what follows from it.
#include <gtest/gtest.h>
#include <fstream>
#include <vector>

#include "adapters/serial/path_watch.hpp"
#include "adapters/serial/reopen_plan.hpp"
#include "tests/unit/serial/pty.hpp"

namespace axisgate::serial {
namespace {

using test::Folder;

class PathWatchTest : public testing::Test {
 protected:
  /// Runs the loop until nothing is ready.
  void turn() {
    context.restart();
    context.poll();
  }
  static void create(const std::string& path) { std::ofstream(path) << ""; }

  Folder folder;
  boost::asio::io_context context;
  int changes = 0;
  PathWatch watch{context, folder / "device", [this] { ++changes; }};
};

TEST_F(PathWatchTest, tells_when_the_path_appears_or_the_right_to_open_it_changes_and_nothing_of_other_names) {
  create(folder / "other");
  create(folder / "device2");
  turn();
  EXPECT_EQ(changes, 0);
  create(folder / "device");
  turn();
  const int before = changes;
  EXPECT_GE(before, 1);
  std::filesystem::permissions(folder / "device", std::filesystem::perms::owner_read);
  turn();
  EXPECT_EQ(changes, before + 1);
}

TEST_F(PathWatchTest, tells_when_a_symlink_is_moved_into_place) {
  test::point(folder / "device", "/nonexistent");
  turn();
  EXPECT_GE(changes, 1);
}

TEST_F(PathWatchTest, many_events_at_once_are_told_once) {
  for (int i = 0; i < 100; ++i) {
    create(folder / "device");
    std::filesystem::remove(folder / "device");
  }
  turn();
  EXPECT_GE(changes, 1);
  EXPECT_LE(changes, 4);
}

TEST(PathWatchFolder, that_comes_later_is_found_by_renew) {
  Folder folder;
  boost::asio::io_context context;
  int changes = 0;
  PathWatch watch(context, folder / "by-id/device", [&changes] { ++changes; });
  EXPECT_FALSE(watch.renew());
  std::filesystem::create_directory(folder / "by-id");
  EXPECT_TRUE(watch.renew());
  std::ofstream(folder / "by-id/device") << "";
  context.poll();
  EXPECT_GE(changes, 1);
}

TEST(PathWatchEnd, a_watch_destroyed_with_events_waiting_or_by_what_it_calls_calls_nobody_after) {
  for (const bool from_inside : {false, true}) {
    Folder folder;
    boost::asio::io_context context;
    int changes = 0;
    std::unique_ptr<PathWatch> watch;
    watch = std::make_unique<PathWatch>(context, folder / "device", [&] {
      ++changes;
      watch.reset();
    });
    std::ofstream(folder / "device") << "";
    if (!from_inside) watch.reset();
    context.poll();
    EXPECT_EQ(watch, nullptr);
    EXPECT_EQ(changes, from_inside ? 1 : 0);
  }
}

// --- When it is tried again ------------------------------------------------------------------------------------------

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

TEST(ReopenPlan, tries_at_once_when_asked_and_a_second_after_a_failure_or_a_loss) {
  ReopenPlan plan;
  EXPECT_EQ(plan.due(), kNever);
  plan.on_request(kStart);
  EXPECT_EQ(plan.due(), kStart);
  plan.on_failure(kStart);
  EXPECT_EQ(plan.due(), kStart + 1s);
  plan.on_open();
  EXPECT_EQ(plan.due(), kNever);
  plan.on_path(kStart);
  EXPECT_EQ(plan.due(), kNever) << "the path of an open device is of no interest";
  plan.on_loss(kStart + 5s);
  EXPECT_EQ(plan.due(), kStart + 6s);
}

TEST(ReopenPlan, tries_when_the_path_appears_each_20_ms_at_most_and_never_later_for_it) {
  const std::pair<std::vector<Duration>, Duration> cases[] = {
      {{300ms}, 300ms}, {{1ms, 2ms}, 20ms}, {{999ms, 1500ms}, 999ms}};
  for (const auto& [appeared, due] : cases) {
    ReopenPlan plan;
    plan.on_failure(kStart);
    for (const Duration at : appeared) plan.on_path(kStart + at);
    EXPECT_EQ(plan.due(), kStart + due);
  }
}

}  // namespace
}  // namespace axisgate::serial
