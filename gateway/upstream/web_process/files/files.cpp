// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/files/files.hpp"

#include <algorithm>
#include <string>

namespace axisgate::web {

const File* find_file(std::string_view path) {
  std::string name(path);
  if (name.ends_with('/')) name += "index.html";
  const auto found = std::ranges::find(files(), std::string_view(name), &File::path);
  return found == files().end() ? nullptr : &*found;
}

}  // namespace axisgate::web
