// SPDX-License-Identifier: Apache-2.0
// `axisgate record` before a page that says what a test wants, on loopback, in a thread of its own.
#include "gateway/commands/record/record_command.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>

#include <boost/asio/write.hpp>
#include <csignal>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>

#include "gateway/commands/record/plan/pieces.hpp"

namespace axisgate::commands {
namespace {

using boost::asio::ip::tcp;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view kNow = "2026-11-28T20:40:00.123456Z";
const std::string kColumns = "time,1.velocity_rpm,event\r\n";

std::string http(unsigned status, const std::string& body) {
  return "HTTP/1.1 " + std::to_string(status) + " X\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\nConnection: close\r\n\r\n" + body;
}
std::string problem(unsigned status, const std::string& detail) {
  return http(status, R"({"status":)" + std::to_string(status) + R"(,"detail":")" + detail + "\"}");
}

/// Of a target "...?name=value&...".
std::string parameter(const std::string& target, const std::string& name) {
  const std::size_t at = target.find(name + "=");
  return at == std::string::npos ? ""
                                 : target.substr(at + name.size() + 1, target.find('&', at) - at - name.size() - 1);
}

/// A motor whose speed is what the second says, and whose history reaches back as far as `oldest`.
class FakePage {
 public:
  FakePage() : thread_([this] { serve(); }) {}
  ~FakePage() {
    ended_ = true;
    boost::system::error_code ignored;
    tcp::socket(io_).connect(acceptor_.local_endpoint(), ignored);
    thread_.join();
  }
  FakePage(const FakePage&) = delete;
  FakePage& operator=(const FakePage&) = delete;

  /// What is answered to a target that begins so, once; empty: the connection is closed.
  void answer_once(std::string begins, std::string answer) {
    const std::lock_guard lock(mutex_);
    once_ = {std::move(begins), std::move(answer)};
  }
  void hold_since(std::string oldest) {
    const std::lock_guard lock(mutex_);
    oldest_ = std::move(oldest);
  }
  void lose_its_gateway() {
    const std::lock_guard lock(mutex_);
    joined_ = "false";
  }
  /// Once, behind the last question of the begin: a second one ends the process.
  void press_ctrl_c() {
    const std::lock_guard lock(mutex_);
    ctrl_c_ = true;
  }
  [[nodiscard]] std::string asked_last() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }
  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/";
  }

 private:
  void serve() {
    while (!ended_) {
      tcp::socket client = acceptor_.accept();
      std::string request;
      boost::system::error_code gone;
      boost::asio::read_until(client, boost::asio::dynamic_buffer(request), "\r\n\r\n", gone);
      if (gone) continue;
      std::istringstream words(request);
      std::string method, target;
      words >> method >> target;
      boost::asio::write(client, boost::asio::buffer(answer(target)), gone);
    }
  }
  [[nodiscard]] std::string answer(const std::string& target) {
    const std::lock_guard lock(mutex_);
    asked_ = target;
    if (target.starts_with("/api/v1/history?") && std::exchange(ctrl_c_, false)) ::kill(::getpid(), SIGINT);
    if (!once_.first.empty() && target.starts_with(once_.first)) return std::exchange(once_, {}).second;
    if (target == "/api/v1/gateway")
      return http(200, R"({"at":")" + std::string(kNow) + R"(","joined":)" + joined_ + "}");
    if (target.starts_with("/api/v1/history?")) return http(200, R"({"oldest":")" + oldest_ + R"("})");
    std::string rows = kColumns;
    for (record::UtcNs at = *record::parse_utc(parameter(target, "from"));
         at <= *record::parse_utc(parameter(target, "to")); at += record::kSecond)
      rows += record::utc_text(at) + "," + record::utc_text(at).substr(17, 2) + ",\r\n";
    return http(200, rows);
  }

  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_{io_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
  std::mutex mutex_;
  std::pair<std::string, std::string> once_;
  std::string asked_;
  bool ctrl_c_ = false;
  std::string oldest_ = "2026-11-28T20:00:00.000000Z";
  std::string joined_ = "true";
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

struct Said {
  int status = 0;
  std::string out;
  std::string err;
};

Said said_by(const RecordOptions& options) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Said said;
  said.status = run(options);
  said.out = testing::internal::GetCapturedStdout();
  said.err = testing::internal::GetCapturedStderr();
  return said;
}

struct RecordCommand : testing::Test {
  /// Seconds before now are there at once.
  [[nodiscard]] RecordOptions before(std::uint32_t seconds) const {
    RecordOptions options;
    options.axes = {"1"};
    options.series = "velocity_rpm";
    options.before = seconds;
    options.url = page.url();
    options.pause = std::chrono::milliseconds(1);
    return options;
  }
  [[nodiscard]] RecordOptions from_now_on() const {
    RecordOptions options = before(0);
    options.seconds = 3600;
    return options;
  }
  FakePage page;
};

TEST_F(RecordCommand, PutsTheSecondsBeforeNowTogether) {
  const Said said = said_by(before(12));
  EXPECT_EQ(said.status, 0) << said.err;
  std::string wanted = kColumns;
  for (int second = 48; second <= 60; ++second) {
    const record::UtcNs at = *record::parse_utc(kNow) + (second - 60) * record::kSecond;
    wanted += record::utc_text(at) + "," + record::utc_text(at).substr(17, 2) + ",\r\n";
  }
  EXPECT_EQ(said.out, wanted);
  EXPECT_EQ(said.err, "");
}

TEST_F(RecordCommand, TakesAnAxisByTheNameThatThePageHas) {
  const std::string axes = http(200, R"({"axes":[{"axis":2,"name":"table"},{"axis":1,"name":"lift"},{"axis":-1},7]})");
  RecordOptions options = before(1);
  options.axes = {"lift"};
  page.answer_once("/api/v1/axes", axes);
  EXPECT_THAT(said_by(options).out, StartsWith(kColumns));
  EXPECT_THAT(page.asked_last(), HasSubstr("series=1.velocity_rpm"));
  options.axes = {"1", "lif"};
  page.answer_once("/api/v1/axes", axes);
  const Said said = said_by(options);
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("is called 'lif'; did you mean \"lift\"? it has 1 \"lift\", 2 \"table\""));
}

TEST_F(RecordCommand, WritesAFileInstead) {
  RecordOptions options = before(1);
  options.output = testing::TempDir() + "record." + std::to_string(::getpid()) + ".csv";
  const Said said = said_by(options);
  std::ostringstream file;
  file << std::ifstream(options.output, std::ios::binary).rdbuf();
  ::unlink(options.output.c_str());
  EXPECT_EQ(said.out, "");
  EXPECT_THAT(file.str(), StartsWith(kColumns + "2026-11-28T20:39:59.123456Z,59,\r\n"));
  options.output = "/nowhere/lift.csv";
  EXPECT_THAT(said_by(options).err, HasSubstr("/nowhere/lift.csv: No such file or directory"));
}

TEST_F(RecordCommand, CtrlCEndsItWithWhatThereIs) {
  page.press_ctrl_c();
  const Said said = said_by(from_now_on());
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, StartsWith(kColumns + std::string(kNow) + ",00,\r\n"));
  EXPECT_THAT(said.err, HasSubstr("1 series for 3600 s; Ctrl-C ends it"));
}

TEST_F(RecordCommand, SaysWhatStandsInItsWay) {
  page.answer_once("/api/v1/history?", problem(400, "series: there is no axis 77; there are: 1, 2"));
  Said said = said_by(from_now_on());
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("there is no axis 77; there are: 1, 2"));
  page.answer_once("/api/v1/gateway", problem(503, "as many connections are open as max_connections allows"));
  EXPECT_THAT(said_by(before(1)).err, HasSubstr("answers 503: as many connections are open"));
  page.answer_once("/api/v1/gateway", "");
  EXPECT_THAT(said_by(before(1)).err, HasSubstr("`allow` of the page does not name this computer"));
  page.answer_once("/api/v1/gateway", http(200, "It works!"));
  EXPECT_THAT(said_by(before(1)).err, HasSubstr("is no page of axisgate"));
  page.answer_once("/api/v1/gateway", "+OK POP3 ready\r\n");
  EXPECT_THAT(said_by(before(1)).err, HasSubstr("speaks no HTTP"));
  page.lose_its_gateway();
  said = said_by(from_now_on());
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("does not hear its gateway"));
  EXPECT_EQ(said_by(before(1)).status, 0) << "what was before is there all the same";
}

TEST_F(RecordCommand, SaysWhatToWriteWhereThereIsNoPage) {
  RecordOptions options = before(1);
  {
    const FakePage gone;
    options.url = gone.url();
  }
  const Said said = said_by(options);
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err,
              AllOf(HasSubstr(options.url + ": Connection refused"), HasSubstr(R"("web": {} in its configuration)")));
}

TEST_F(RecordCommand, SaysWhatTheHistoryDoesNotHold) {
  page.hold_since("2026-11-28T20:39:57.000000Z");
  const Said said = said_by(before(3600));
  EXPECT_EQ(said.status, 0);
  EXPECT_THAT(said.err, HasSubstr("does not hold 2026-11-28T19:40:00.123456Z to 2026-11-28T20:39:57.000000Z"));
  EXPECT_THAT(said.out, StartsWith(kColumns + "2026-11-28T20:39:57.000000Z,57,\r\n"))
      << "and asks for what it holds alone";
}

TEST_F(RecordCommand, SaysWhatTheHistoryLostMeanwhile) {
  page.press_ctrl_c();
  page.answer_once("/api/v1/history?", http(200, R"({"oldest":null})"));
  page.hold_since("2026-11-28T20:40:00.124000Z");
  const Said said = said_by(from_now_on());
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("does not hold 2026-11-28T20:40:00.123456Z to 2026-11-28T20:40:00.124000Z"));
}

TEST_F(RecordCommand, AsksAgainWhereThePageIsFull) {
  page.answer_once("/api/v1/history.csv", problem(503, "others have not taken their answers yet"));
  const Said said = said_by(before(1));
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr(std::string(kNow) + ",00,\r\n"));
}

TEST_F(RecordCommand, RefusesMoreSeriesThanThePageAnswers) {
  RecordOptions options = before(1);
  options.axes.assign(17, "1");
  const Said said = said_by(options);
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("17 series are more than the page answers at once, which is 16"));
}

}  // namespace
}  // namespace axisgate::commands
