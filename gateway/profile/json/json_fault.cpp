// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/json/json_fault.hpp"

namespace axisgate::profile {

std::string text(const Fault& fault) {
  std::string out = fault.file;
  if (fault.place.line > 0) out += ":" + std::to_string(fault.place.line) + ":" + std::to_string(fault.place.column);
  out += ": ";
  if (!fault.pointer.empty()) out += fault.pointer + ": ";
  return out + fault.message;
}

void locate(std::vector<Fault>& faults, const std::vector<FileRead>& read) {
  for (const FileRead& file : read) {
    std::vector<Fault*> of_it;
    std::vector<std::string> pointers;
    for (Fault& fault : faults) {
      if (fault.file != file.file || fault.place.line > 0 || !file.text) continue;
      of_it.push_back(&fault);
      pointers.push_back(fault.pointer);
    }
    if (pointers.empty()) continue;
    const std::vector<JsonPlace> places = places_of(*file.text, pointers);
    for (std::size_t i = 0; i < places.size(); ++i) of_it[i]->place = places[i];
  }
}

}  // namespace axisgate::profile
