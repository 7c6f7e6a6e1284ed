// SPDX-License-Identifier: Apache-2.0
// Linked with whole_state.cpp in place of libc's ptrace(), as User-Mode Linux is run. Every processor with AVX has more
// state than the part that is set here, so the refusal that ends the guest on processors with AMX comes on the others,
// too.
#include <elf.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <vector>

namespace {

constexpr std::size_t kWithoutAvx = 576;  // the old FXSAVE area and the header of what follows
constexpr std::size_t kXmm0 = 160;
constexpr std::size_t kMost = 1U << 16U;

void* kind() { return reinterpret_cast<void*>(std::uintptr_t{NT_X86_XSTATE}); }

/// A child process that stands still and is traced by the test.
class Traced : public ::testing::Test {
 protected:
  void SetUp() override {
    child_ = ::fork();
    ASSERT_NE(child_, -1);
    if (child_ == 0) {
      ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
      ::raise(SIGSTOP);
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child_, &status, 0), child_);
    ASSERT_TRUE(WIFSTOPPED(status));
  }
  void TearDown() override {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }

  std::vector<unsigned char> state() {
    std::vector<unsigned char> out(kMost);
    iovec all{out.data(), out.size()};
    EXPECT_EQ(::ptrace(PTRACE_GETREGSET, child_, kind(), &all), 0);
    out.resize(all.iov_len);
    return out;
  }
  long set(std::vector<unsigned char>& state) {
    iovec given{state.data(), state.size()};
    return ::ptrace(PTRACE_SETREGSET, child_, kind(), &given);
  }

  pid_t child_ = -1;
};

TEST_F(Traced, AStateShorterThanTheProcessorsIsSetAndTheRestStays) {
  const std::vector<unsigned char> before = state();
  ASSERT_GT(before.size(), kWithoutAvx) << "a processor without AVX shows nothing here";
  std::vector<unsigned char> part(before.begin(), before.begin() + kWithoutAvx);
  part[kXmm0] ^= 0xFFU;
  part[512] |= 2U;  // the header: XMM registers are not as they were at the start
  ASSERT_EQ(set(part), 0) << "errno " << errno;
  std::vector<unsigned char> wanted = before;
  std::copy(part.begin(), part.end(), wanted.begin());
  EXPECT_EQ(state(), wanted);
}

TEST_F(Traced, AWholeStateIsSetAsItIs) {
  std::vector<unsigned char> whole = state();
  whole[kXmm0] ^= 0xFFU;
  whole[512] |= 2U;
  ASSERT_EQ(set(whole), 0) << "errno " << errno;
  EXPECT_EQ(state(), whole);
}

TEST_F(Traced, WhatIsPeekedIsTheResult) {
  static const long word = 0x1234'5678'9ABC'DEF0;
  errno = 1;
  EXPECT_EQ(::ptrace(PTRACE_PEEKDATA, child_, const_cast<long*>(&word), nullptr), word);
  EXPECT_EQ(errno, 0);
  EXPECT_EQ(::ptrace(PTRACE_PEEKDATA, child_, nullptr, nullptr), -1);
  EXPECT_EQ(errno, EIO);
}

TEST_F(Traced, ARefusalIsPassedOn) {
  EXPECT_EQ(::ptrace(PTRACE_SETREGSET, 0, kind(), nullptr), -1);
  EXPECT_EQ(errno, ESRCH);
}

}  // namespace
