// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/program/memory_limit.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::program {
namespace {

// The limit counts stacks whole: a library's dozen threads would take 8 MiB each.
constexpr std::size_t kThreadStack = 1024 * 1024;
constexpr int kMallocArenas = 2;
/// Of the limit, for what a look at the loop's pace may miss. The library rejects samples where malloc fails for one,
/// and would go on for ever with less than one block of its pools left.
constexpr std::uint64_t kReserve = 3 * 1024 * 1024;

constexpr std::string_view kMemoryLine = ": memory limit reached (memory_limit_mb, --memory-limit-mib): ends\n";

/// On a thread of a library, which throws bad_alloc itself where its malloc fails; nobody catches it there.
[[noreturn]] void on_terminate() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    end_for_memory();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: not caught: %s\n", program_invocation_short_name, error.what());
  } catch (...) {
  }
  std::abort();
}

}  // namespace

void end_for_memory() {
  // No stream and no string: there may be no memory for either.
  for (const std::string_view part : {std::string_view(program_invocation_short_name), kMemoryLine})
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part.data(), part.size());
  _exit(link::kExitMemory);
}

void check_memory() {
  rlimit limit{};
  std::array<char, 128> text{};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  // size resident shared text lib data dt, in pages (proc(5))
  unsigned long data_pages = 0;
  if (size <= 0 || std::sscanf(text.data(), "%*u %*u %*u %*u %*u %lu", &data_pages) != 1) return;
  const auto used = std::uint64_t{data_pages} * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && used + kReserve > limit.rlim_cur) {
    end_for_memory();
  }
}

void limit_memory([[maybe_unused]] std::uint32_t mib) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kThreadStack);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  mallopt(M_ARENA_MAX, kMallocArenas);
#ifndef __SANITIZE_ADDRESS__  // its shadow memory would count as well
  const rlimit limit{rlim_t{mib} << 20, rlim_t{mib} << 20};
  setrlimit(RLIMIT_DATA, &limit);
#endif
  std::set_new_handler(end_for_memory);
  std::set_terminate(on_terminate);
}

}  // namespace axisgate::program
