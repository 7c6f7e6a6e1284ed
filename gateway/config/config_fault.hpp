// SPDX-License-Identifier: Apache-2.0
// One mistake in a configuration or profile: where it is and what to change.
// Promises the same form everywhere: "FILE: /json/pointer: message".
// Never stands for a mistake of the program itself.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace axisgate::config {

struct ConfigFault {
  std::string file;
  std::string pointer;  ///< RFC 6901; empty: the whole file
  std::string message;  ///< what is wrong, and what to change
  friend bool operator==(const ConfigFault&, const ConfigFault&) = default;
};
[[nodiscard]] std::string text(const ConfigFault& fault);

/// Gathers the mistakes and warnings of one file while it is read.
class ConfigFaults {
 public:
  explicit ConfigFaults(std::string file) : file_(std::move(file)) {}

  void add(std::string_view pointer, std::string_view message);
  void add(ConfigFault fault);
  void warn(std::string_view pointer, std::string_view message);

  /// Something at or below this place is wrong.
  [[nodiscard]] bool within(std::string_view pointer) const;
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<ConfigFault>& faults() const { return faults_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::string file_;
  std::vector<ConfigFault> faults_;
  std::vector<std::string> warnings_;
};

}  // namespace axisgate::config
