// SPDX-License-Identifier: Apache-2.0
// The mistakes and warnings of one configuration file, gathered while it is read.
// Promises to keep each once, and to know what is wrong already, so that nothing is reported twice.
// Never reads the file: where in its text they stand is looked up behind the reading (locate()).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/profile/json/json_fault.hpp"

namespace axisgate::config {

/// Of this file, or of a profile that it names.
using ConfigFault = profile::Fault;
using profile::text;

class ConfigFaults {
 public:
  explicit ConfigFaults(std::string file) : file_(std::move(file)) {}

  void add(std::string_view pointer, std::string_view message);
  void add(ConfigFault fault);
  void locate(const std::vector<profile::FileRead>& read);
  void warn(std::string_view pointer, std::string_view message);

  /// Something at or below this place is wrong.
  [[nodiscard]] bool within(std::string_view pointer) const;
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<ConfigFault>& faults() const { return faults_; }
  [[nodiscard]] const std::vector<ConfigFault>& warnings() const { return warnings_; }

 private:
  std::string file_;
  std::vector<ConfigFault> faults_;
  std::vector<ConfigFault> warnings_;
};

}  // namespace axisgate::config
