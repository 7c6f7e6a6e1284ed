// SPDX-License-Identifier: Apache-2.0
// Pages that look: connections of their own with a stream each, read as fast as it comes, by one thread.
// Promises that nothing waits for what is read. Never is a browser: what a browser takes is its own.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace axisgate::bench {

class Looking {
 public:
  /// Returns when each has had its first `axes` event. @param period_ms of the streams, 50..5000
  /// @param series of each stream, with commas between; empty: none
  Looking(std::uint16_t port, int pages, int period_ms, const std::string& series = "");
  ~Looking();
  Looking(const Looking&) = delete;
  Looking& operator=(const Looking&) = delete;

  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// How long from now until the first page reads this; throws where it does not within 10 s.
  [[nodiscard]] std::chrono::duration<double> until_first_page_reads(const std::string& text);
  /// What to look for, before it is made to come.
  void look_for(std::string text);

  /// What one request is answered with, head and body.
  static std::string get(std::uint16_t port, std::string_view path);

 private:
  void read();
  void take(std::size_t page, std::string_view text);

  std::vector<int> sockets_;
  std::vector<bool> seen_;
  std::size_t left_ = 0;
  std::promise<void> all_seen_;
  std::mutex mutex_;
  std::string wanted_;
  std::string tail_;
  std::promise<std::chrono::steady_clock::time_point> found_;
  std::chrono::steady_clock::time_point asked_{};
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace axisgate::bench
