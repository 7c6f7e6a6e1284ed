// SPDX-License-Identifier: Apache-2.0
// Lowers the number of descriptors this process may have, for a scope.
// Promises the limit from before at its end. Never touches the hard limit, which nobody could raise again.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace axisgate::test {

class FewDescriptors {
 public:
  explicit FewDescriptors(rlim_t limit) {
    EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0);
    rlimit lowered = before_;
    lowered.rlim_cur = limit;
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &lowered), 0);
  }
  ~FewDescriptors() { EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before_), 0); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

}  // namespace axisgate::test
