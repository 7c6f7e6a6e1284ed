// SPDX-License-Identifier: Apache-2.0
// axisgate-sim in a process of its own, with the lines it is told, and its control socket.
// Promises that every port it was told of is there when it is made, and that it ends with the object.
// Never understands a line or an answer: those are the simulator's.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/process.hpp"

namespace axisgate::bench {

class SimulatorProcess {
 public:
  /// `lines`: each as `--line` takes it, PATH:DRIVES. `control`: where its socket shall be; empty: none.
  /// Throws std::runtime_error when a port does not appear.
  explicit SimulatorProcess(const std::vector<std::string>& lines, std::string control = {});

  /// What it answers to this line of its control socket, without the "ok". Throws std::runtime_error on any other.
  [[nodiscard]] std::string ask(std::string_view line) const;

 private:
  void await(const std::string& path);

  std::string control_;
  Process process_;
};

}  // namespace axisgate::bench
