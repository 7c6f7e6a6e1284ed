// SPDX-License-Identifier: Apache-2.0
// What stands before libc's clock, timer and sigsuspend() in the process of User-Mode Linux's kernel, and nowhere
// else: in_guest compiles and preloads it. Promises that the time of the guest is its own: it passes with the
// processor time that the guest uses, and where all its processes wait, the instant comes at once that the first of
// them waits for. So minutes of waiting take no time, and a machine that is busy with something else, or stands still
// for a while, cannot be noticed inside. Never changes any other clock than the monotonic one, which is the only one
// that this kernel reads after its start.
#include <dlfcn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace {

/// A system call takes this kernel about so many times as long as one of the processor's own kernel.
constexpr std::int64_t kSlower = 4;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr pid_t kMostProcesses = 1 << 22;  // Linux's own limit

// A signal's handler may read the clock while it is being read: what is changed is changed in one place alone, which
// no handler comes to.
std::int64_t skipped = kSecond;      ///< by waiting; the guest takes a clock that reads 0 for one that is not there
std::int64_t used_by_processes = 0;  ///< processor time of the guest's processes, which are children of this one
std::int64_t used_before[kMostProcesses];  ///< by process number
std::int64_t due = 0;                      ///< when the timer expires; 0: never
std::int64_t period = 0;

template <typename Function>
Function* libcs(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}
const auto real_settime = libcs<decltype(::timer_settime)>("timer_settime");
const auto real_sigsuspend = libcs<decltype(::sigsuspend)>("sigsuspend");
const auto real_waitpid = libcs<decltype(::waitpid)>("waitpid");

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * kSecond + time.tv_nsec; }
timespec timespec_of(std::int64_t time) { return {.tv_sec = time / kSecond, .tv_nsec = time % kSecond}; }

std::int64_t used(clockid_t clock) {
  timespec time{};
  return ::syscall(SYS_clock_gettime, clock, &time) == 0 ? nanoseconds(time) : 0;
}

/// As clock_getcpuclockid() makes it, without asking whether there is such a process.
clockid_t clock_of(pid_t process) { return static_cast<clockid_t>(~static_cast<unsigned>(process) << 3U | 2U); }

std::int64_t now() { return skipped + (used(CLOCK_PROCESS_CPUTIME_ID) + used_by_processes) / kSlower; }

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock != CLOCK_MONOTONIC) return static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  *time = timespec_of(now());
  return 0;
}

extern "C" pid_t waitpid(pid_t process, int* status, int options) {
  const pid_t found = real_waitpid(process, status, options);
  if (found > 0 && found < kMostProcesses) {
    const std::int64_t total = used(clock_of(found));
    std::int64_t& before = used_before[found];
    // Less than before: another process, with the number of one that has ended.
    used_by_processes += total < before ? total : total - before;
    before = total;
  }
  return found;
}

/// The timer that is really set ends a computation that asks for nothing. Where it comes too early, because the
/// processor had others to serve, the kernel of the guest sees that nothing is due, and sets it anew.
extern "C" int timer_settime(timer_t timer, int flags, const itimerspec* value, itimerspec* old) noexcept {
  const std::int64_t first = nanoseconds(value->it_value);
  period = nanoseconds(value->it_interval);
  due = first == 0 ? 0 : now() + first;
  const itimerspec longer{.it_interval = timespec_of(period * kSlower), .it_value = timespec_of(first * kSlower)};
  return real_settime(timer, flags, &longer, old);
}

/// Called where every process of the guest waits, with the timer's signal blocked.
extern "C" int sigsuspend(const sigset_t* set) {
  if (due != 0) {
    if (const std::int64_t left = due - now(); left > 0) skipped += left;
    due = period == 0 ? 0 : due + period;
    ::kill(::getpid(), SIGALRM);
  }
  return real_sigsuspend(set);
}
