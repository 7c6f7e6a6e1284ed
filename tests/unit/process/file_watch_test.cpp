// SPDX-License-Identifier: Apache-2.0
// Gateway alarm "configuration changed": what is on the disk against what was read from it.
#include "gateway/process/file_watch.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <boost/asio/executor_work_guard.hpp>
#include <filesystem>
#include <fstream>

#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::process {
namespace {

namespace fs = std::filesystem;

class FileWatching : public testing::Test {
 protected:
  FileWatching() {
    fs::create_directories(folder_);
    write("gateway.json", "{}");
  }
  ~FileWatching() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string place(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  /// What is told once the next look has come to its end; none: nothing.
  [[nodiscard]] std::optional<std::string> told_next() {
    told_.reset();
    runtime_.advance_by(FileWatch::kPeriod);
    io_.run_one();
    return told_;
  }
  void watch(std::vector<profile::FileRead> read) {
    watch_.emplace(io_, runtime_, std::move(read), [this](const std::string& file) { told_ = file; });
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("axisgate_watch_" + std::to_string(::getpid()));
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  test::ManualRuntime runtime_;
  std::optional<std::string> told_;
  std::optional<FileWatch> watch_;
};

TEST_F(FileWatching, AFileThatWasChangedSinceItWasReadIsToldAndSoIsItsReturn) {
  watch({{place("gateway.json"), "{}"}});
  EXPECT_EQ(told_next(), std::nullopt);
  write("gateway.json", "{ }");
  EXPECT_EQ(told_next(), place("gateway.json"));
  EXPECT_EQ(told_next(), std::nullopt) << "once";
  write("gateway.json", "{}");
  EXPECT_EQ(told_next(), "");
}

TEST_F(FileWatching, AFileThatWasChangedBetweenTheReadingAndTheFirstLookIsTold) {
  write("gateway.json", "{ }");
  watch({{place("gateway.json"), "{}"}});
  EXPECT_EQ(told_next(), place("gateway.json"));
  watch_->take({{place("gateway.json"), "{ }"}});
  EXPECT_EQ(told_next(), "");
}

TEST_F(FileWatching, AFileThatAppearsWhereOneWouldHaveBeenTakenIsTold) {
  watch({{place("gateway.json"), "{}"}, {place("kinco-jd.json")}});
  EXPECT_EQ(told_next(), std::nullopt);
  write("kinco-jd.json", "{}");
  EXPECT_EQ(told_next(), place("kinco-jd.json"));
  fs::remove(place("kinco-jd.json"));
  EXPECT_EQ(told_next(), "");
}

TEST_F(FileWatching, APipeInAFilesPlaceHoldsNobodyUp) {
  fs::remove(place("gateway.json"));
  ASSERT_EQ(::mkfifo(place("gateway.json").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(place("kinco-jd.json").c_str(), 0600), 0);
  watch({{place("kinco-jd.json")}, {place("gateway.json"), "{}"}});
  EXPECT_EQ(told_next(), place("gateway.json"));
}

}  // namespace
}  // namespace axisgate::process
