// SPDX-License-Identifier: Apache-2.0
// `axisgate support` on this computer, where no gateway runs: programs that hang, files that are there, answers to its
// question. What a running one gives away, tests/integration/web_process_test.py tells.
#include "gateway/commands/support/support_command.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "gateway/commands/support/archive.hpp"
#include "gateway/commands/support/bounded_run.hpp"
#include "gateway/commands/support/device_facts.hpp"

namespace axisgate::commands {
namespace {

namespace fs = std::filesystem;
using support::device_facts;
using support::run_program;
using support::RunEnd;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// What tar says of an archive.
std::string tar(const std::string& how, const fs::path& archive) {
  return run_program({"tar", how, archive.string()}, {.bytes = 1 << 20}).text;
}

struct Said {
  int status = 0;
  std::string out;
  std::string err;
};

struct SupportCommand : testing::Test {
  SupportCommand() {
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::ofstream(folder / "gateway.json")
        << R"({"note": "hunter2", "buses": [{"name": "lift", "device": "/dev/null"}]} // Jane)";
    options.config = folder / "gateway.json";
    options.output = folder / "s.tar.gz";
    options.axisgate = "/bin/echo";
    options.yes = true;
  }
  ~SupportCommand() override { fs::remove_all(folder); }

  [[nodiscard]] Said said(const std::string& typed = "") const {
    std::istringstream input(typed);
    std::streambuf* const before = std::cin.rdbuf(input.rdbuf());
    std::cin.clear();
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Said said;
    said.status = run(options);
    said.out = testing::internal::GetCapturedStdout();
    said.err = testing::internal::GetCapturedStderr();
    std::cin.rdbuf(before);
    return said;
  }

  fs::path folder = fs::path(testing::TempDir()) / ("support." + std::to_string(::getpid()));
  SupportOptions options;
};

TEST_F(SupportCommand, WritesWhatItHasListedForItsOwnerAlone) {
  const Said told = said();
  EXPECT_EQ(told.status, 0) << told.err;
  struct stat file {};
  ASSERT_EQ(::stat(options.output.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0600U);
  const std::string names = tar("-tzf", options.output);
  for (const char* const name :
       {"s/README.txt\n", "s/configuration.json\n", "s/check.txt\n", "s/versions.txt\n", "s/devices.txt\n"})
    EXPECT_THAT(names, HasSubstr(name));
  EXPECT_THAT(names, Not(HasSubstr("page/"))) << "there is none";
  EXPECT_THAT(told.out,
              AllOf(HasSubstr("page/axes.json       the configuration has no page"), HasSubstr("/note: no key"),
                    HasSubstr("top.txt              the configuration has no listener")));
  const std::string all = tar("-xzOf", options.output);
  EXPECT_THAT(all,
              AllOf(HasSubstr("check " + options.config), HasSubstr("character device 1:3"), HasSubstr("glibc 2.")));
  EXPECT_THAT(all, AllOf(Not(HasSubstr("hunter2")), Not(HasSubstr("Jane"))));
}

TEST_F(SupportCommand, WritesNothingWithoutAYes) {
  options.yes = false;
  for (const char* const typed : {"", "\n", "y\n", "no\n", "yes please\n"}) {
    EXPECT_EQ(said(typed).status, 1) << typed;
    EXPECT_FALSE(fs::exists(options.output)) << typed;
  }
  const Said told = said("yes\n");
  EXPECT_EQ(told.status, 0);
  EXPECT_THAT(told.out, HasSubstr("Only \"yes\" does: "));
  EXPECT_TRUE(fs::exists(options.output));
}

TEST_F(SupportCommand, WritesOverNoFileAndFollowsNoLink) {
  std::ofstream(options.output) << "mine";
  EXPECT_THAT(said().err, HasSubstr("is there already, and is not written over"));
  EXPECT_EQ(read(options.output), "mine");
  fs::remove(options.output);
  fs::create_symlink(folder / "elsewhere", options.output);
  EXPECT_EQ(said().status, 1);
  EXPECT_FALSE(fs::exists(folder / "elsewhere"));
  options.output = folder / "none/s.tar.gz";
  EXPECT_THAT(said().err, HasSubstr("No such file or directory"));
}

TEST_F(SupportCommand, HasAllElseWhereTheConfigurationIsNoJsonOrNoFile) {
  std::ofstream(options.config) << "{\"hosts\": [\"press.example\",]";
  EXPECT_EQ(said().status, 0);
  const std::string all = tar("-xzOf", options.output);
  EXPECT_THAT(all, AllOf(HasSubstr("configuration.json   it is no JSON: line 1, column "), HasSubstr("glibc 2."),
                         Not(HasSubstr("press"))));
  EXPECT_THAT(all,
              AllOf(HasSubstr("check.txt            its words show parts"), Not(HasSubstr("check " + options.config))));
  fs::remove(options.output);
  fs::remove(options.config);
  ASSERT_EQ(::mkfifo(options.config.c_str(), 0600), 0);  // nobody ever writes to it
  EXPECT_THAT(said().out, HasSubstr("configuration.json   it cannot be read"));
}

TEST_F(SupportCommand, IsNotKeptByAProgramThatHangs) {
  options.axisgate = folder / "hangs";
  std::ofstream(options.axisgate) << "#!/bin/sh\necho so far\nexec sleep 1000\n";
  fs::permissions(options.axisgate, fs::perms::owner_all);
  options.patience = std::chrono::milliseconds(300);
  EXPECT_THAT(said().out, HasSubstr("check.txt            no end within 0.3 s: it was killed"));
  EXPECT_THAT(tar("-xzOf", options.output), HasSubstr("so far\n"));
}

TEST_F(SupportCommand, AFileThatComesMeanwhileIsNotWrittenOver) {
  options.axisgate = folder / "slow";
  std::ofstream(options.axisgate) << "#!/bin/sh\necho theirs > " << options.output << "\n";
  fs::permissions(options.axisgate, fs::perms::owner_all);
  EXPECT_THAT(said().err, HasSubstr("is there already, and is not written over"));
  EXPECT_EQ(read(options.output), "theirs\n");
}

TEST_F(SupportCommand, AsksAPageThatHangsOnce) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::acceptor never_answers(io, {boost::asio::ip::address_v4::loopback(), 0});
  const std::string place = "127.0.0.1:" + std::to_string(never_answers.local_endpoint().port());
  std::ofstream(options.config) << R"({"web": {"listen": ")" + place + "\"}}";
  options.patience = std::chrono::milliseconds(300);
  const Said told = said();
  EXPECT_EQ(told.status, 0);
  for (const char* const file : {"gateway.json    ", "metrics.txt     "})
    EXPECT_THAT(told.out, HasSubstr("page/" + std::string(file) + "http://" + place + "/: no answer within 0.3 s"));
  never_answers.non_blocking(true);
  boost::system::error_code none;
  never_answers.accept();
  static_cast<void>(never_answers.accept(none));
  EXPECT_EQ(none, boost::asio::error::would_block);
}

TEST(BoundedRun, KeepsTheEndOrTheBeginningOfWhatIsTooMuch) {
  const std::string many = "i=0; while [ $i -lt 5000 ]; do echo line $i; i=$((i+1)); done";
  RunEnd run = run_program({"sh", "-c", many}, {.bytes = 20});
  EXPECT_EQ(run.text, "line 0\nline 1\nline 2");
  EXPECT_THAT(run.problem, HasSubstr("more than the 20 bytes"));
  run = run_program({"sh", "-c", many}, {.bytes = 20, .newest_is_last = true});
  EXPECT_THAT(run.text, testing::EndsWith("line 4998\nline 4999\n"));
  EXPECT_LE(run.text.size(), 40U);
  run = run_program({"sh", "-c", "echo out; echo err >&2; cat; exit 3"}, {.bytes = 100});
  EXPECT_EQ(run.text, "out\nerr\n");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run_program({"no-such-program"}, {.bytes = 100}).problem, "there is no no-such-program here");
  EXPECT_THAT(run_program({"sh", "-c", "kill -9 $$"}, {.bytes = 100}).problem, HasSubstr("signal 9"));
  // It has closed what we read, and goes on.
  run = run_program({"sh", "-c", "exec >&- 2>&-; exec sleep 1000"}, {std::chrono::milliseconds(200), 100});
  EXPECT_THAT(run.problem, StartsWith("no end within"));
}

TEST(DeviceFacts, TellWhoHasItOpenAndWhatIsNotThere) {
  const fs::path file = fs::path(testing::TempDir()) / ("device." + std::to_string(::getpid()));
  const int open = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  EXPECT_THAT(device_facts({"lift", file}),
              AllOf(StartsWith(file.string() + " (bus \"lift\")\n"), HasSubstr("no character device"),
                    HasSubstr("mode 0640"), HasSubstr("(pid " + std::to_string(::getpid()) + ", user ")));
  ::close(open);
  EXPECT_THAT(device_facts({"lift", file}), HasSubstr("open in no process"));
  fs::remove(file);
  EXPECT_THAT(device_facts({"lift", file}), HasSubstr("No such file or directory"));
  EXPECT_THAT(device_facts({"x", "", "lo"}), HasSubstr("  type 772\n"));
  EXPECT_THAT(device_facts({"x", "", "can77"}), HasSubstr("no such interface"));
  EXPECT_THAT(device_facts({"x", "", "../tty"}), HasSubstr("no such interface"));
}

TEST(SupportArchive, IsOneThatTarAndGzipRead) {
  std::string much;
  for (unsigned i = 0; i < 300000; ++i) much += static_cast<char>((i * 2654435761U) >> 24U);
  const fs::path path = fs::path(testing::TempDir()) / ("archive." + std::to_string(::getpid()));
  for (const std::string& text : {std::string(), std::string(512, 'x'), much}) {
    std::ofstream(path, std::ios::binary)
        << support::gzip_of(support::tar_of({{"a/b.txt", text}, {"a/c", "end"}}, 1764400000));
    EXPECT_EQ(run_program({"gzip", "-t", path.string()}, {.bytes = 100}).exit_code, 0);
    EXPECT_EQ(tar("-xzOf", path), text + "end");
    EXPECT_THAT(tar("-tvzf", path), HasSubstr("-rw-------"));
  }
  fs::remove(path);
}

}  // namespace
}  // namespace axisgate::commands
