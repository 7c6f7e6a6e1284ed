// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/program/wake.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::program {

Wake::Wake() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw StartError(link::kExitInternal, "no descriptor for an eventfd: raise the limit of open files");
}

Wake::~Wake() { close(fd_); }

void Wake::set() {
  // It fails only where the counter is full, and then the reader will wake anyway.
  [[maybe_unused]] const int done = eventfd_write(fd_, 1);
}

void Wake::clear() {
  eventfd_t count = 0;
  [[maybe_unused]] const int done = eventfd_read(fd_, &count);
}

}  // namespace axisgate::program
