#include "adapters/serial/path_watch.hpp"

#include <fstream>

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

TEST_F(PathWatchTest, tells_when_the_path_appears) {
  turn();
  EXPECT_EQ(changes, 0);
  create(folder / "device");
  turn();
  EXPECT_GE(changes, 1);
}

TEST_F(PathWatchTest, tells_when_a_symlink_is_moved_into_place) {
  test::point(folder / "device", "/nonexistent");
  turn();
  EXPECT_GE(changes, 1);
}

TEST_F(PathWatchTest, tells_when_the_right_to_open_it_changes) {
  create(folder / "device");
  turn();
  const int before = changes;
  std::filesystem::permissions(folder / "device", std::filesystem::perms::owner_read);
  turn();
  EXPECT_EQ(changes, before + 1);
}

TEST_F(PathWatchTest, says_nothing_about_other_names) {
  create(folder / "other");
  create(folder / "device2");
  turn();
  EXPECT_EQ(changes, 0);
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

TEST(PathWatchEnd, a_watch_destroyed_with_events_waiting_calls_nobody) {
  Folder folder;
  boost::asio::io_context context;
  int changes = 0;
  auto watch = std::make_unique<PathWatch>(context, folder / "device", [&changes] { ++changes; });
  std::ofstream(folder / "device") << "";
  watch.reset();
  context.poll();
  EXPECT_EQ(changes, 0);
}

TEST(PathWatchEnd, a_watch_may_be_destroyed_by_what_it_calls) {
  Folder folder;
  boost::asio::io_context context;
  std::unique_ptr<PathWatch> watch;
  watch = std::make_unique<PathWatch>(context, folder / "device", [&watch] { watch.reset(); });
  std::ofstream(folder / "device") << "";
  context.poll();
  EXPECT_EQ(watch, nullptr);
}

}  // namespace
}  // namespace axisgate::serial
