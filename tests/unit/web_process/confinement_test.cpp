// SPDX-License-Identifier: Apache-2.0
// What a process that is confined to a folder can still do with files, and that without a folder it can do nothing of
// it.
#include "gateway/upstream/web_process/system/confinement.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

namespace axisgate::web {
namespace {

namespace fs = std::filesystem;

class Confined : public ::testing::Test {
 protected:
  Confined() : path(fs::path(::testing::TempDir()) / ("confined." + std::to_string(getpid()))) {
    fs::remove_all(path);
    fs::create_directories(path / "in");
    std::ofstream(path / "in" / "there") << "there";
    std::ofstream(path / "out") << "out";
    folder = ::open((path / "in").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  }
  ~Confined() override {
    ::close(folder);
    fs::remove_all(path);
  }

  /// What a confined process gets for it: 0, an errno, or minus the signal that ended it.
  int tried(const std::function<long()>& call, bool with_folder = true) const {
    const pid_t pid = fork();
    if (pid == 0) {
      const Confinement done = confine(with_folder ? folder : -1);
      if (!done.confined || done.writes != with_folder) _exit(EXIT_FAILURE + kNotConfined);
      _exit(call() >= 0 ? 0 : errno);
    }
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] long make(const char* name) const { return open_at(folder, name, new_file_flags()); }
  [[nodiscard]] static long open_at(int where, const char* name, int flags, unsigned mode = kNewFileMode) {
    return syscall(SYS_openat, where, name, flags, mode);
  }

  static constexpr int kNotConfined = 200;
  const fs::path path;
  int folder = -1;
};

/// Where the kernel has no Landlock no folder is written at all: then there is nothing to keep inside it.
bool has_landlock() { return syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0; }

TEST_F(Confined, WithoutAFolderMakesRenamesAndRemovesNothing) {
  EXPECT_EQ(tried([&] { return make("new"); }, false), EPERM);
  EXPECT_EQ(tried([&] { return syscall(SYS_renameat2, folder, "there", folder, "new", 0); }, false), EPERM);
  EXPECT_EQ(tried([&] { return syscall(SYS_unlinkat, folder, "there", 0); }, false), EPERM);
  EXPECT_EQ(tried([] { return socket(AF_INET, SOCK_STREAM, 0); }, false), -SIGSYS);
}

TEST_F(Confined, MakesRenamesAndRemovesInItsFolder) {
  ASSERT_TRUE(has_landlock()) << "tests need a kernel of Debian 12 or newer";
  EXPECT_EQ(tried([&] {
              const long file = make("new.part");
              if (file < 0 || ::write(static_cast<int>(file), "x", 1) != 1) return -1L;
              return syscall(SYS_renameat2, folder, "new.part", folder, "new", 0);
            }),
            0);
  EXPECT_TRUE(fs::exists(path / "in" / "new"));
  EXPECT_EQ(tried([&] { return syscall(SYS_unlinkat, folder, "new", 0); }), 0);
  EXPECT_FALSE(fs::exists(path / "in" / "new"));
}

TEST_F(Confined, OpensNothingThatIsThere) {
  EXPECT_EQ(tried([&] { return make("there"); }), EEXIST);
  EXPECT_EQ(tried([&] { return make("/dev/null"); }), EEXIST);
  EXPECT_EQ(tried([&] { return open_at(folder, "there", O_RDONLY | O_CLOEXEC); }), EPERM);
  EXPECT_EQ(tried([&] { return open_at(folder, "there", O_WRONLY | O_NOFOLLOW | O_CLOEXEC); }), EPERM);
  EXPECT_EQ(tried([&] { return open_at(folder, "new", new_file_flags() & ~O_EXCL); }), EPERM);
  EXPECT_EQ(tried([&] { return open_at(folder, "new", new_file_flags() | O_TRUNC); }), EPERM);
  EXPECT_EQ(tried([&] { return open_at(folder, "new", new_file_flags(), 04755); }), EPERM);
  EXPECT_EQ(tried([&] { return open_at(AT_FDCWD, "new", new_file_flags()); }), EPERM);
}

TEST_F(Confined, LeavesItsFolderByNoName) {
  EXPECT_EQ(tried([&] { return make("../new"); }), EACCES);
  EXPECT_EQ(tried([&] { return make((path / "new").c_str()); }), EACCES);
  EXPECT_EQ(tried([&] { return syscall(SYS_unlinkat, folder, "../out", 0); }), EACCES);
  EXPECT_EQ(tried([&] { return syscall(SYS_unlinkat, folder, (path / "out").c_str(), 0); }), EACCES);
  EXPECT_NE(tried([&] { return syscall(SYS_renameat2, folder, "there", folder, "../out", 0); }), 0);
  EXPECT_NE(tried([&] { return syscall(SYS_renameat2, folder, "../out", folder, "there", 0); }), 0);
  EXPECT_TRUE(fs::exists(path / "out"));
  EXPECT_FALSE(fs::exists(path / "new"));
}

TEST_F(Confined, StillOpensNoSocketAndNoProgram) {
  EXPECT_EQ(tried([] { return socket(AF_CAN, SOCK_RAW, 0); }), -SIGSYS);
  EXPECT_EQ(tried([] { return execl("/bin/true", "/bin/true", nullptr); }), -SIGSYS);
}

}  // namespace
}  // namespace axisgate::web
