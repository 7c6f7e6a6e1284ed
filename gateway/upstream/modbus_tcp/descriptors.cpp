#include "gateway/upstream/modbus_tcp/descriptors.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>

namespace axisgate::modbus_tcp {

DescriptorRule descriptor_rule(std::uint64_t soft_limit) {
  const std::uint64_t above = soft_limit > kSelectLimit ? soft_limit - kSelectLimit : 0;
  const std::uint64_t low = std::min(soft_limit, kSelectLimit);
  const std::uint64_t below = low > kOwnDescriptors ? low - kOwnDescriptors : 0;
  const std::uint64_t room = std::max(above, below);
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  return {above >= below && above > 0, static_cast<std::uint32_t>(std::min(room, kMost))};
}

std::uint64_t raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    // Refused (a container's policy): the old limit stays, and descriptor_rule() makes do with it.
    static_cast<void>(setrlimit(RLIMIT_NOFILE, &limit));
  }
  return descriptor_limit();
}

std::uint64_t descriptor_limit() {
  rlimit limit{};
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : kSelectLimit;
}

int moved_up(int descriptor) {
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, static_cast<int>(kSelectLimit));
  const int why = errno;
  ::close(descriptor);
  errno = why;
  return moved;
}

}  // namespace axisgate::modbus_tcp
