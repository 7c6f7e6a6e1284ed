// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/system/memory_limit.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "gateway/upstream/dds_link/exit_codes.hpp"

namespace axisgate::dds {
namespace {

// The limit counts stacks whole: the library's dozen threads would take 8 MiB each.
constexpr std::size_t kThreadStack = 1024 * 1024;
constexpr int kMallocArenas = 2;
/// Of the limit, for what a look at the loop's pace may miss. The library rejects samples where malloc fails for one,
/// and would go on for ever with less than one block of its pools left.
constexpr std::uint64_t kReserve = 3 * 1024 * 1024;

/// On a thread of the library, which throws bad_alloc itself where its malloc fails; nobody catches it there.
[[noreturn]] void on_terminate() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    end_for_memory();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "axisgate-dds: not caught: %s\n", error.what());
  } catch (...) {
  }
  std::abort();
}

}  // namespace

void end_for_memory() {
  constexpr std::string_view kLine = "axisgate-dds: memory limit reached (--memory-limit-mib): ends\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLine.data(), kLine.size());
  _exit(kExitMemory);
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

void limit_memory(std::uint32_t mib) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kThreadStack);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  mallopt(M_ARENA_MAX, kMallocArenas);
  const rlimit limit{rlim_t{mib} << 20, rlim_t{mib} << 20};
  setrlimit(RLIMIT_DATA, &limit);
  std::set_new_handler(end_for_memory);
  std::set_terminate(on_terminate);
}

}  // namespace axisgate::dds
