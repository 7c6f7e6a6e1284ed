// SPDX-License-Identifier: Apache-2.0
// What stands before libc's ptrace() in the process of User-Mode Linux's kernel, and nowhere else: in_guest compiles
// and preloads it. Linux sets a traced process's extended state (XSAVE) only as a whole. User-Mode Linux 6.1 has room
// for 2,696 bytes of it; a processor with AMX has 11,008, and the kernel of the guest dies at its first process:
// "ptrace set fp regs failed, errno = 14". Promises that a state too short for this processor is completed with what
// the process has already, and that every other request does what libc does. Never changes what the caller gave.
#include <elf.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstring>

namespace {

/// Larger than any processor's state. Not on the stack, since the stacks of the guest's kernel are smaller; one will
/// do, since its kernel runs on one processor and is not preempted.
constexpr std::size_t kMostState = 1U << 16U;
alignas(64) unsigned char whole[kMostState];

long ask_kernel(long request, long pid, void* address, void* data) {
  return ::syscall(SYS_ptrace, request, pid, address, data);
}

/// The kernel writes what it peeks to `data`; libc's callers get it as the result.
long peek(long request, long pid, void* address) {
  long word = 0;
  const long result = ask_kernel(request, pid, address, &word);
  if (result < 0) return result;
  errno = 0;
  return word;
}

long set_state(long request, long pid, void* kind, void* data) {
  const long result = ask_kernel(request, pid, kind, data);
  if (result == 0 || errno != EFAULT) return result;
  const iovec& given = *static_cast<const iovec*>(data);
  iovec all{whole, sizeof whole};
  if (ask_kernel(PTRACE_GETREGSET, pid, kind, &all) != 0 || all.iov_len <= given.iov_len) {
    errno = EFAULT;
    return result;
  }
  std::memcpy(whole, given.iov_base, given.iov_len);
  return ask_kernel(request, pid, kind, &all);
}

}  // namespace

extern "C" long ptrace(enum __ptrace_request request, ...) noexcept {
  std::va_list rest;
  va_start(rest, request);
  const long pid = va_arg(rest, pid_t);
  void* const address = va_arg(rest, void*);
  void* const data = va_arg(rest, void*);
  va_end(rest);
  if (request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER)
    return peek(request, pid, address);
  if (request == PTRACE_SETREGSET && reinterpret_cast<std::uintptr_t>(address) == NT_X86_XSTATE)
    return set_state(request, pid, address, data);
  return ask_kernel(request, pid, address, data);
}
