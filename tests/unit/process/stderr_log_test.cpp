// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/stderr_log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace axisgate::process {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Standard error leads elsewhere while this lives.
class Elsewhere {
 public:
  explicit Elsewhere(int to) : own_(::dup(STDERR_FILENO)) { ::dup2(to, STDERR_FILENO); }
  ~Elsewhere() {
    ::dup2(own_, STDERR_FILENO);
    ::close(own_);
    std::clearerr(stderr);
  }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;
  /// From now on, as where somebody makes room on a disk.
  static void lead(int to) { ::dup2(to, STDERR_FILENO); }

 private:
  int own_;
};

struct Pipe {
  Pipe() {
    EXPECT_EQ(::pipe(ends.data()), 0);
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    for (const int end : ends) ::close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  [[nodiscard]] std::string read() const {
    std::string all;
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = ::read(ends[0], part.data(), part.size())) > 0;)
      all.append(part.data(), static_cast<std::size_t>(got));
    return all;
  }
  std::array<int, 2> ends{};
};

TEST(StderrLog, CountsTheLinesThatAFullDiskHasNotTaken) {
  const int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  const Pipe pipe;
  std::string told;
  {
    const Elsewhere elsewhere(full);
    const Log log = stderr_log(LogLevel::info);
    for (int line = 0; line < 3; ++line) log.write(LogLevel::info, "bus lift", "lost");
    Elsewhere::lead(pipe.ends[1]);
    log.write(LogLevel::info, "bus lift", "there is room again");
    log.write(LogLevel::info, "bus lift", "and still");
    told = pipe.read();
  }
  ::close(full);
  EXPECT_THAT(told, HasSubstr("(3 lines lost here: nobody took them)\n"));
  EXPECT_THAT(told, HasSubstr("bus lift: there is room again\n"));
  EXPECT_THAT(told.substr(told.find("room again")), Not(HasSubstr("lost here")));
}

TEST(StderrLog, CountsTheLinesThatNobodyReads) {
  const Pipe pipe;
  std::string first, told;
  int written = 0;
  {
    const Elsewhere elsewhere(pipe.ends[1]);
    const Log log = stderr_log(LogLevel::info);
    // More than any pipe holds: not one of them waits.
    constexpr int kLines = 4'000;
    const std::string words(400, 'x');
    for (; written < kLines; ++written) log.write(LogLevel::info, "bus lift", words);
    first = pipe.read();
    log.write(LogLevel::info, "bus lift", "it is read again");
    told = pipe.read();
  }
  const auto taken = static_cast<int>(std::count(first.begin(), first.end(), '\n'));
  EXPECT_GT(taken, 0);
  EXPECT_LT(taken, written);
  EXPECT_THAT(told, HasSubstr("(" + std::to_string(written - taken) + " lines lost here: nobody took them)\n"));
  EXPECT_THAT(told, HasSubstr("it is read again\n"));
}

/// A journal that takes datagrams, as many as a kernel keeps for who does not look.
class FakeJournal {
 public:
  FakeJournal() {
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    path.copy(at.sun_path, sizeof at.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  }
  ~FakeJournal() {
    close();
    ::close(socket_);
  }
  FakeJournal(const FakeJournal&) = delete;
  FakeJournal& operator=(const FakeJournal&) = delete;
  void close() const { ::unlink(path.c_str()); }
  [[nodiscard]] std::vector<std::string> entries() const {
    std::vector<std::string> all;
    std::array<char, 4096> entry{};
    for (ssize_t got = 0; (got = ::recv(socket_, entry.data(), entry.size(), MSG_DONTWAIT)) > 0;)
      all.emplace_back(entry.data(), static_cast<std::size_t>(got));
    return all;
  }
  const std::string path = testing::TempDir() + "journal." + std::to_string(::getpid());

 private:
  int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

/// As systemd starts a service whose stderr the journal reads.
struct UnderSystemd : testing::Test {
  ~UnderSystemd() override { ::unsetenv("JOURNAL_STREAM"); }
  static void say_that_the_journal_reads(int descriptor) {
    struct stat its {};
    ASSERT_EQ(::fstat(descriptor, &its), 0);
    ::setenv("JOURNAL_STREAM", (std::to_string(its.st_dev) + ":" + std::to_string(its.st_ino)).c_str(), 1);
  }
  [[nodiscard]] std::string written() const {
    const Elsewhere elsewhere(pipe.ends[1]);
    const Log log = stderr_log(LogLevel::info, journal.path);
    log.write(LogLevel::warning, bus_source("lift"), "link down");
    log.write(LogLevel::info, bus_source("lift"), "link up");
    return pipe.read();
  }
  const Pipe pipe;
  const FakeJournal journal;
};

TEST_F(UnderSystemd, TheJournalIsToldPriorityAxisBusAndEventInFields) {
  say_that_the_journal_reads(pipe.ends[1]);
  const Elsewhere elsewhere(pipe.ends[1]);
  const Log log = stderr_log(LogLevel::info, journal.path);
  log.write(LogLevel::warning, {.words = "axis 3 lift", .axis = 3, .bus = "serial", .event = "fault"}, "too hot");
  log.write(LogLevel::error, "gateway", "one\ntwo");
  EXPECT_THAT(journal.entries(),
              testing::ElementsAre("PRIORITY=4\nSYSLOG_IDENTIFIER=axisgate\nAXIS=3\nBUS=serial\nEVENT=fault\n"
                                   "MESSAGE=warning axis 3 lift: too hot\n",
                                   std::string("PRIORITY=3\nSYSLOG_IDENTIFIER=axisgate\nMESSAGE\n") + '\x16' +
                                       std::string(7, '\0') + "error gateway: one\ntwo\n"));
  EXPECT_EQ(pipe.read(), "") << "once";
}

TEST_F(UnderSystemd, AJournalThatHangsIsNotWaitedForAndLosesNothing) {
  say_that_the_journal_reads(pipe.ends[1]);
  const Elsewhere elsewhere(pipe.ends[1]);
  const Log log = stderr_log(LogLevel::info, journal.path);
  // More than any kernel keeps; a pipe holds them.
  constexpr std::size_t kLines = 1'000;
  for (std::size_t line = 0; line < kLines; ++line) log.write(LogLevel::info, "web", "x");
  const std::string rest = pipe.read();
  const auto of_pipe = static_cast<std::size_t>(std::count(rest.begin(), rest.end(), '\n'));
  const std::size_t of_journal = journal.entries().size();
  EXPECT_GT(of_journal, 0U);
  EXPECT_THAT(rest, testing::StartsWith("<6>info web: x\n"));
  EXPECT_EQ(of_journal + of_pipe, kLines);
  log.write(LogLevel::info, "web", "it looks again");
  EXPECT_THAT(journal.entries(), testing::ElementsAre(HasSubstr("MESSAGE=info web: it looks again\n")));
}

TEST_F(UnderSystemd, TheJournalIsGivenAPriorityAndNoTime) {
  say_that_the_journal_reads(pipe.ends[1]);
  journal.close();
  EXPECT_EQ(written(), "<4>warning bus lift: link down\n<6>info bus lift: link up\n");
}

TEST_F(UnderSystemd, WhatIsRedirectedHasItsOwnTime) {
  const Pipe other;
  say_that_the_journal_reads(other.ends[1]);
  const std::string lines = written();
  EXPECT_THAT(lines, testing::ContainsRegex("^[0-9-]+ [0-9:.]+ warning bus lift: link down\n"));
  EXPECT_THAT(lines, Not(HasSubstr("<4>")));
  EXPECT_THAT(journal.entries(), testing::IsEmpty());
}

}  // namespace
}  // namespace axisgate::process
