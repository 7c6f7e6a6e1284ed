// SPDX-License-Identifier: Apache-2.0
// Runs the real program as a shell would, in a folder of the test's own.
// Promises its exit code and all it said on both outputs.
// Never waits for a time: only for the program's end.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/profiles/mistakes.hpp"

namespace axisgate::config {

struct Ended {
  int code = -1;
  std::string out;
  std::string err;
};

class ProgramTest : public ::testing::Test {
 protected:
  /// Of axisgate itself.
  [[nodiscard]] Ended run(const std::string& arguments) const {
    return run_command(std::string(AXISGATE_PROGRAM) + " " + arguments);
  }
  /// Of a line for the shell.
  [[nodiscard]] Ended run_command(const std::string& command) const {
    const std::filesystem::path out = folder() / "out";
    const std::filesystem::path err = folder() / "err";
    const std::string line = "(" + command + ") >" + out.string() + " 2>" + err.string() + " </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::content(out), test::content(err)};
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return own_.path(); }
  std::string write(const std::string& name, const std::string& text) const { return own_.write(name, text).string(); }

  /// Where this process alone listens: all of 127.0.0.0/8 is this machine.
  [[nodiscard]] static std::string listen() {
    const int pid = getpid();
    return fmt::format("127.{}.{}.{}:15989", 1 + (pid >> 16) % 250, (pid >> 8) & 255, pid & 255);
  }
  /// A Kinco JD at `node` of one line.
  [[nodiscard]] static std::string one_drive(const std::string& device, int node, const std::string& more) {
    return R"({"modbus_tcp": [{"listen": ")" + listen() +
           R"("}], "buses": [{"name": "a", "adapter": "kinco-serial", "device": ")" + device +
           R"(", "drives": [{"profile": "kinco-jd", "node": )" + std::to_string(node) +
           R"(, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}])" + more + "}";
  }

 private:
  const test::OwnFolder own_;
};

}  // namespace axisgate::config
