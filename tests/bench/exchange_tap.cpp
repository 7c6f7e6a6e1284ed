// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/exchange_tap.hpp"

#include <sys/mman.h>

#include <new>
#include <stdexcept>

namespace axisgate::bench {

std::vector<TappedExchange> ExchangeTap::since(std::uint64_t first) const {
  const std::uint64_t end = recorded();
  std::vector<TappedExchange> found;
  found.reserve(end - first);
  for (std::uint64_t number = first; number < end; ++number) found.push_back(kept_[number % kKept]);
  if (recorded() - first > kKept) throw std::runtime_error("more exchanges than the tap keeps: measure for less long");
  return found;
}

SharedTap::SharedTap() {
  void* memory =
      ::mmap(nullptr, sizeof(ExchangeTap), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  tap_ = new (memory) ExchangeTap;
}

SharedTap::~SharedTap() { ::munmap(tap_, sizeof(ExchangeTap)); }

}  // namespace axisgate::bench
