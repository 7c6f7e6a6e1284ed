// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/system/confinement.hpp"

#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace axisgate::web {
namespace {

/// What it takes to wait, accept, read and write, and what the C library takes for memory, clocks and an end.
constexpr std::array kAllowed{SCMP_SYS(accept),
                              SCMP_SYS(accept4),
                              SCMP_SYS(brk),
                              SCMP_SYS(clock_getres),
                              SCMP_SYS(clock_gettime),
                              SCMP_SYS(clock_nanosleep),
                              SCMP_SYS(close),
                              SCMP_SYS(epoll_ctl),
                              SCMP_SYS(epoll_pwait),
                              SCMP_SYS(epoll_wait),
                              SCMP_SYS(exit),
                              SCMP_SYS(exit_group),
                              SCMP_SYS(fcntl),
                              SCMP_SYS(fstat),
                              SCMP_SYS(futex),
                              SCMP_SYS(getpeername),
                              SCMP_SYS(getpid),
                              SCMP_SYS(getrandom),
                              SCMP_SYS(getsockname),
                              SCMP_SYS(getsockopt),
                              SCMP_SYS(gettid),
                              SCMP_SYS(gettimeofday),
                              SCMP_SYS(lseek),
                              SCMP_SYS(madvise),
                              SCMP_SYS(mmap),
                              SCMP_SYS(mprotect),
                              SCMP_SYS(mremap),
                              SCMP_SYS(munmap),
                              SCMP_SYS(newfstatat),
                              SCMP_SYS(poll),
                              SCMP_SYS(ppoll),
                              SCMP_SYS(read),
                              SCMP_SYS(readv),
                              SCMP_SYS(recvfrom),
                              SCMP_SYS(recvmsg),
                              SCMP_SYS(restart_syscall),
                              SCMP_SYS(rseq),
                              SCMP_SYS(rt_sigaction),
                              SCMP_SYS(rt_sigprocmask),
                              SCMP_SYS(rt_sigreturn),
                              SCMP_SYS(sched_yield),
                              SCMP_SYS(sendmsg),
                              SCMP_SYS(sendto),
                              SCMP_SYS(setsockopt),
                              SCMP_SYS(shutdown),
                              SCMP_SYS(sigaltstack),
                              SCMP_SYS(timerfd_settime),
                              SCMP_SYS(write),
                              SCMP_SYS(writev)};

constexpr std::array kEndsIt{SCMP_SYS(socket),
                             SCMP_SYS(socketpair),
                             SCMP_SYS(connect),
                             SCMP_SYS(bind),
                             SCMP_SYS(listen),
                             SCMP_SYS(execve),
                             SCMP_SYS(execveat),
                             SCMP_SYS(fork),
                             SCMP_SYS(vfork),
                             SCMP_SYS(clone),
                             SCMP_SYS(clone3),
                             SCMP_SYS(ptrace),
                             SCMP_SYS(process_vm_readv),
                             SCMP_SYS(process_vm_writev),
                             SCMP_SYS(io_uring_setup),
                             SCMP_SYS(bpf),
                             SCMP_SYS(kill),
                             SCMP_SYS(mount)};

/// Of ioctl what asks how a socket stands, and makes it wait or not.
constexpr std::array<unsigned long, 3> kAsked{FIONBIO, FIONREAD, TIOCOUTQ};

/// One that this kind of processor does not have needs no rule.
bool is_added(int result) { return result == 0 || result == -EDOM; }

bool allow_with(scmp_filter_ctx filter, int call, unsigned argument, std::uint64_t value) {
  const scmp_arg_cmp only{argument, SCMP_CMP_EQ, value, 0};
  return is_added(seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &only));
}

bool add_rules(scmp_filter_ctx filter) {
  for (const int call : kAllowed)
    if (!is_added(seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0))) return false;
  for (const int call : kEndsIt)
    if (!is_added(seccomp_rule_add(filter, SCMP_ACT_KILL_PROCESS, call, 0))) return false;
  for (const unsigned long request : kAsked)
    if (!allow_with(filter, SCMP_SYS(ioctl), 1, request)) return false;
  // An abort is a signal to itself.
  return allow_with(filter, SCMP_SYS(tgkill), 0, static_cast<std::uint64_t>(getpid()));
}

}  // namespace

bool confine() {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return false;
  const bool done = add_rules(filter) && seccomp_load(filter) == 0;
  seccomp_release(filter);
  return done;
}

}  // namespace axisgate::web
