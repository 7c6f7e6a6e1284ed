// SPDX-License-Identifier: Apache-2.0
// A Lawicel adapter as its manual (CAN232, version 3) describes it: commands in, answers out, and a CAN bus of its own.
// Written from the manual, without the gateway's codec.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate::test {

class LawicelAdapter {
 public:
  bool acknowledges = true;  ///< many cheap ones do not
  bool bus_off = false;      ///< refuses what it is told to transmit
  unsigned flags = 0;        ///< of command F

  /// What it answers to these bytes.
  std::string hear(std::string_view bytes) {
    std::string answers;
    for (const char byte : bytes) {
      if (byte != '\r') {
        command_ += byte;
        continue;
      }
      const std::string answer = obey(std::exchange(command_, {}));
      if (acknowledges) answers += answer;
    }
    return answers;
  }
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] char rate() const { return rate_; }
  /// What it has put on its bus, each as the command said it.
  std::vector<std::string> transmitted;

 private:
  std::string obey(const std::string& command) {
    if (command.empty()) return "\r";
    switch (command[0]) {
      case 'V':
        return "V1013\r";
      case 'C':
        return std::exchange(open_, false) ? "\r" : "\a";
      case 'S':
        if (open_ || command.size() != 2) return "\a";
        rate_ = command[1];
        return "\r";
      case 'O':
        if (open_ || rate_ == 0) return "\a";
        open_ = true;
        bus_off = false;
        return "\r";
      case 'F': {
        if (!open_) return "\a";
        constexpr std::string_view kDigits = "0123456789ABCDEF";
        return {'F', kDigits[flags >> 4], kDigits[flags & 15U], '\r'};
      }
      case 't':
      case 'r':
        return transmit(command, "z\r");
      case 'T':
      case 'R':
        return transmit(command, "Z\r");
      default:
        return "\a";
    }
  }
  std::string transmit(const std::string& command, std::string answer) {
    if (!open_ || bus_off) return "\a";
    transmitted.push_back(command);
    return answer;
  }

  std::string command_;
  bool open_ = false;
  char rate_ = 0;
};

}  // namespace axisgate::test
