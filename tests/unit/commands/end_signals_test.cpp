// SPDX-License-Identifier: Apache-2.0
// What a signal does that comes while the gateway still starts: it is answered then.
#include "gateway/commands/common/end_signals.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <csignal>
#include <vector>

namespace axisgate::commands {
namespace {

TEST(EndSignals, OneThatComesBeforeTheLoopRunsEndsItOnPurpose) {
  boost::asio::io_context io(1);
  const Log log([](LogLevel, std::string_view, std::string_view) {});
  EndSignals signals(io, log);
  ASSERT_EQ(std::raise(SIGTERM), 0);
  std::vector<bool> ends;
  signals.start(
      [&](bool at_once) {
        ends.push_back(at_once);
        at_once ? io.stop() : static_cast<void>(std::raise(SIGINT));
      },
      [] {});
  io.run();
  EXPECT_EQ(ends, (std::vector<bool>{false, true}));
}

TEST(EndSignals, WhatNobodyMeansAsTheEndEndsNothing) {
  boost::asio::io_context io(1);
  const Log log([](LogLevel, std::string_view, std::string_view) {});
  EndSignals signals(io, log);
  int ends = 0;
  signals.start(
      [&](bool) {
        ++ends;
        io.stop();
      },
      [] {});
  for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF}) ASSERT_EQ(std::raise(signal), 0);
  io.poll();
  EXPECT_EQ(ends, 0);
  ASSERT_EQ(std::raise(SIGQUIT), 0);
  io.run();
  EXPECT_EQ(ends, 1);
}

}  // namespace
}  // namespace axisgate::commands
