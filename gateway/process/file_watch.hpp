// SPDX-License-Identifier: Apache-2.0
// Whether what was read at the start, or at the last reload, still is what a start would read (gateway alarm
// "configuration changed"). Promises that a disk which hangs never holds up the loop: files are read on a thread of
// their own, one look at a time. Never reads more of a file than its first kMaxWatchedBytes, and never does anything
// about a change.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::process {

class FileWatch {
 public:
  static constexpr Duration kPeriod = std::chrono::seconds(2);

  /// `read` is what runs. `on_change(file)`: on the loop, when the answer changes: the first file that differs, is gone
  /// or has appeared; empty: none does any more.
  FileWatch(boost::asio::io_context& io, Runtime& runtime, std::vector<profile::FileRead> read,
            std::function<void(const std::string& file)> on_change);
  /// From now on these are what runs.
  void take(std::vector<profile::FileRead> read);

 private:
  void look();
  void on_looked(const std::string& file);

  boost::asio::io_context& io_;
  Runtime& runtime_;
  std::vector<profile::FileRead> watched_;  ///< the thread's, once it runs
  std::function<void(const std::string&)> on_change_;
  std::string reported_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  ///< what is posted to the loop may outlive this
  std::unique_ptr<Timer> timer_;
  boost::asio::thread_pool thread_{1};  ///< last: joined before the rest goes
};

}  // namespace axisgate::process
