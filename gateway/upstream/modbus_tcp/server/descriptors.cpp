// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>

namespace axisgate::modbus_tcp {

DescriptorLimits descriptor_limits() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return {kSelectLimit, kSelectLimit};
  return {limit.rlim_cur, limit.rlim_max};
}

DescriptorPlan take_descriptors(const DescriptorNeeds& needs) {
  const DescriptorLimits before = descriptor_limits();
  const DescriptorPlan plan = plan_descriptors(before, needs);
  if (plan.soft_limit == before.soft) return plan;
  const rlimit raised{plan.soft_limit, before.hard};
  if (setrlimit(RLIMIT_NOFILE, &raised) == 0) return plan;
  // Refused (a container's policy): the plan makes do with what is in force.
  return plan_descriptors({before.soft, before.soft}, needs);
}

int moved_up(int descriptor) {
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, static_cast<int>(kSelectLimit));
  const int why = errno;
  ::close(descriptor);
  errno = why;
  return moved;
}

}  // namespace axisgate::modbus_tcp
