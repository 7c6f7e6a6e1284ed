// SPDX-License-Identifier: Apache-2.0
// Files as the bytes of a .tar.gz: ustar (POSIX.1-1988), compressed by the deflate of Boost.Beast, which axisgate has
// for its page anyway: no program is called, since the container image has none, and no library is added to the
// gateway. Pure. Promises what tar, 7-Zip and Explorer open; one input gives the same bytes. Never writes a file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate::commands::support {

/// Of the name of a file with that of its folder: what ustar has room for.
inline constexpr std::size_t kLongestName = 100;

struct ArchivedFile {
  std::string name;  ///< with its folder; at most kLongestName
  std::string text;
};
/// @param seconds since 1970: when the files were made
[[nodiscard]] std::string tar_of(const std::vector<ArchivedFile>& files, std::uint64_t seconds);
/// RFC 1952.
[[nodiscard]] std::string gzip_of(std::string_view bytes);

}  // namespace axisgate::commands::support
