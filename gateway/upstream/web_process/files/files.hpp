// SPDX-License-Identifier: Apache-2.0
// The files of the page, as they were when the program was built: a table in memory, by name.
// Promises that no name of a request becomes a path: what is not in the table is not there.
// Never reads a file.
#pragma once

#include <span>
#include <string_view>

namespace axisgate::web {

struct File {
  std::string_view path;  ///< "/axis.html"
  std::string_view type;  ///< "text/html; charset=utf-8"
  std::string_view etag;  ///< a weak one: both forms have it
  std::string_view plain;
  std::string_view gzip;  ///< empty where it is no shorter
};

[[nodiscard]] std::span<const File> files();
/// Null: there is none. A path that ends with '/' is that folder's index.html.
[[nodiscard]] const File* find_file(std::string_view path);

}  // namespace axisgate::web
