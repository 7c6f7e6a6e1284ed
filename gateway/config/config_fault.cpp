// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_fault.hpp"

#include <algorithm>

namespace axisgate::config {

void ConfigFaults::add(std::string_view pointer, std::string_view message) {
  add(ConfigFault{file_, std::string(pointer), std::string(message)});
}

void ConfigFaults::add(ConfigFault fault) {
  // Two drives with the same bad profile would otherwise tell each of its mistakes twice.
  if (std::ranges::find(faults_, fault) == faults_.end()) faults_.push_back(std::move(fault));
}

void ConfigFaults::warn(std::string_view pointer, std::string_view message) {
  warnings_.push_back(ConfigFault{file_, std::string(pointer), std::string(message)});
}

void ConfigFaults::locate(const std::vector<profile::FileRead>& read) {
  profile::locate(faults_, read);
  profile::locate(warnings_, read);
}

bool ConfigFaults::within(std::string_view pointer) const {
  return std::ranges::any_of(faults_, [&](const ConfigFault& fault) {
    if (fault.file != file_ || !std::string_view(fault.pointer).starts_with(pointer)) return false;
    return fault.pointer.size() == pointer.size() || fault.pointer[pointer.size()] == '/';
  });
}

}  // namespace axisgate::config
