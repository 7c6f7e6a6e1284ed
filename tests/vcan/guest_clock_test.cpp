// SPDX-License-Identifier: Apache-2.0
// Linked with guest_clock.cpp in place of libc's clock, timer and sigsuspend(), as User-Mode Linux is run.
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <ctime>

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kHour = 3'600'000 * kMillisecond;
/// Of processor time, which a test uses in no case between two of its lines.
constexpr std::int64_t kMuch = 10'000 * kMillisecond;

std::int64_t read(clockid_t clock) {
  timespec time{};
  EXPECT_EQ(::clock_gettime(clock, &time), 0);
  return time.tv_sec * 1000 * kMillisecond + time.tv_nsec;
}
std::int64_t guest_time() { return read(CLOCK_MONOTONIC); }
std::int64_t processor_time() { return read(CLOCK_PROCESS_CPUTIME_ID); }

void compute(std::int64_t time) {
  const std::int64_t end = processor_time() + time;
  while (processor_time() < end) continue;
}

volatile std::sig_atomic_t alarms = 0;

/// One timer, as the kernel of the guest has it: its signal is blocked but while it waits.
class GuestClock : public ::testing::Test {
 protected:
  void SetUp() override {
    alarms = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { alarms = alarms + 1; };
    ASSERT_EQ(::sigaction(SIGALRM, &action, nullptr), 0);
    action.sa_handler = [](int) {};
    ASSERT_EQ(::sigaction(SIGUSR1, &action, nullptr), 0);
    sigset_t blocked;
    ::sigemptyset(&blocked);
    ::sigaddset(&blocked, SIGALRM);
    ::sigaddset(&blocked, SIGUSR1);
    ASSERT_EQ(::sigprocmask(SIG_BLOCK, &blocked, &open_), 0);
    ::sigdelset(&open_, SIGALRM);
    ::sigdelset(&open_, SIGUSR1);
    ASSERT_EQ(::timer_create(CLOCK_MONOTONIC, nullptr, &timer_), 0);
  }
  void TearDown() override { ::timer_delete(timer_); }

  void set(std::int64_t first, std::int64_t period = 0) {
    const std::int64_t second = 1000 * kMillisecond;
    const itimerspec value{.it_interval = {.tv_sec = period / second, .tv_nsec = period % second},
                           .it_value = {.tv_sec = first / second, .tv_nsec = first % second}};
    ASSERT_EQ(::timer_settime(timer_, 0, &value, nullptr), 0);
  }
  void wait() const { ::sigsuspend(&open_); }

  timer_t timer_{};
  sigset_t open_{};
};

TEST_F(GuestClock, an_hour_that_all_wait_for_is_over_at_once) {
  const std::int64_t before = guest_time();
  set(kHour);
  wait();
  EXPECT_EQ(alarms, 1);
  EXPECT_GE(guest_time(), before + kHour);
  EXPECT_LT(guest_time(), before + kHour + kMuch);
}

TEST_F(GuestClock, a_period_goes_on) {
  const std::int64_t before = guest_time();
  set(kHour, 2 * kHour);
  for (int i = 0; i < 3; ++i) wait();
  EXPECT_EQ(alarms, 3);
  EXPECT_GE(guest_time(), before + 5 * kHour);
  EXPECT_LT(guest_time(), before + 5 * kHour + kMuch);
}

TEST_F(GuestClock, without_a_timer_it_waits_for_another_signal_and_no_time_is_skipped) {
  set(kHour);
  set(0);
  const std::int64_t before = guest_time();
  const pid_t self = ::getpid();
  const pid_t other = ::fork();
  if (other == 0) {
    ::kill(self, SIGUSR1);
    ::_exit(0);
  }
  wait();
  EXPECT_EQ(alarms, 0);
  EXPECT_LT(guest_time(), before + kHour);
  ::waitpid(other, nullptr, 0);
}

TEST_F(GuestClock, it_passes_with_the_processor_time_and_not_while_others_run) {
  const std::int64_t used = processor_time();
  const std::int64_t before = guest_time();
  ::usleep(100'000);  // nobody sees it
  compute(20 * kMillisecond);
  const std::int64_t passed = guest_time() - before;
  EXPECT_GE(passed, 20 * kMillisecond / 4);
  EXPECT_LE(passed, (processor_time() - used) / 4 + 1);
}

TEST_F(GuestClock, it_passes_with_the_processor_time_of_the_guests_processes) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    compute(40 * kMillisecond);
    for (int i = 0; i < 2; ++i) ::raise(SIGSTOP);
    ::_exit(0);
  }
  const std::int64_t before = guest_time();
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_GE(guest_time(), before + 40 * kMillisecond / 4);
  const std::int64_t counted = guest_time();
  ::ptrace(PTRACE_CONT, child, nullptr, nullptr);
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSTOPPED(status)) << "again";
  EXPECT_LT(guest_time(), counted + 40 * kMillisecond / 4) << "counted once";
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
}

TEST_F(GuestClock, a_computation_is_ended_by_the_timer) {
  set(5 * kMillisecond);
  sigset_t pending;
  do {
    ASSERT_EQ(::sigpending(&pending), 0);
  } while (::sigismember(&pending, SIGALRM) == 0);
  wait();
  EXPECT_EQ(alarms, 1);
}

TEST_F(GuestClock, the_wall_clock_is_the_machines) {
  constexpr std::int64_t kMinute = 60;
  const std::int64_t seconds = read(CLOCK_REALTIME) / (1000 * kMillisecond);
  EXPECT_GE(seconds, ::time(nullptr) - kMinute);
  EXPECT_LE(seconds, ::time(nullptr) + kMinute);
}

}  // namespace
