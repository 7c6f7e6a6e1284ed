// SPDX-License-Identifier: Apache-2.0
// Where the sources and what is built stand. Only places.cpp is compiled with these paths, so that a test compiled in
// one folder is the same object in another (ccache).
#pragma once

#include <string>
#include <string_view>

namespace axisgate::test {

/// The path of what stands there below the project's root.
[[nodiscard]] std::string source_path(std::string_view below);
/// The same below the build folder.
[[nodiscard]] std::string build_path(std::string_view below);

}  // namespace axisgate::test
