// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/system/confinement.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <initializer_list>
#include <vector>

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

struct Only {
  unsigned argument;
  std::uint64_t value;
};

/// The call with these arguments alone.
bool allow_with(scmp_filter_ctx filter, int call, std::initializer_list<Only> arguments) {
  std::vector<scmp_arg_cmp> only;
  for (const Only& each : arguments) only.push_back({each.argument, SCMP_CMP_EQ, each.value, 0});
  return is_added(
      seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, static_cast<unsigned>(only.size()), only.data()));
}

/// A filter sees no names: which ones the calls may have, Landlock says.
bool add_files(scmp_filter_ctx filter, int folder) {
  const auto in = static_cast<std::uint64_t>(folder);
  return allow_with(filter, SCMP_SYS(openat),
                    {{0, in}, {2, static_cast<std::uint64_t>(new_file_flags())}, {3, kNewFileMode}}) &&
         allow_with(filter, SCMP_SYS(renameat2), {{0, in}, {2, in}, {4, 0}}) &&
         allow_with(filter, SCMP_SYS(unlinkat), {{0, in}, {2, 0}});
}

bool add_rules(scmp_filter_ctx filter, int folder) {
  for (const int call : kAllowed)
    if (!is_added(seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0))) return false;
  for (const int call : kEndsIt)
    if (!is_added(seccomp_rule_add(filter, SCMP_ACT_KILL_PROCESS, call, 0))) return false;
  for (const unsigned long request : kAsked)
    if (!allow_with(filter, SCMP_SYS(ioctl), {{1, request}})) return false;
  if (folder >= 0 && !add_files(filter, folder)) return false;
  // An abort is a signal to itself.
  return allow_with(filter, SCMP_SYS(tgkill), {{0, static_cast<std::uint64_t>(getpid())}});
}

/// From here on files can be made, written, renamed and removed in this folder alone. False: the kernel cannot do that.
bool keep_names_in(int folder) {
  constexpr std::uint64_t kNewFiles = LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_WRITE_FILE;
  landlock_ruleset_attr all{};
  all.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;  // all that the first version knows
  const auto rules = static_cast<int>(syscall(SYS_landlock_create_ruleset, &all, sizeof(all.handled_access_fs), 0));
  if (rules < 0) return false;
  landlock_path_beneath_attr here{};
  here.allowed_access = kNewFiles | LANDLOCK_ACCESS_FS_REMOVE_FILE;
  here.parent_fd = folder;
  const bool kept = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &here, 0) == 0 &&
                    syscall(SYS_landlock_restrict_self, rules, 0) == 0;
  close(rules);
  return kept;
}

}  // namespace

int new_file_flags() { return O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC; }

Confinement confine(int folder) {
  Confinement out;
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return out;
  out.writes = folder >= 0 && keep_names_in(folder);
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return out;
  out.confined = add_rules(filter, out.writes ? folder : -1) && seccomp_load(filter) == 0;
  seccomp_release(filter);
  return out;
}

}  // namespace axisgate::web
