// SPDX-License-Identifier: Apache-2.0
#include "tests/places.hpp"

namespace axisgate::test {

std::string source_path(std::string_view below) { return AXISGATE_SOURCE_DIR "/" + std::string(below); }

std::string build_path(std::string_view below) { return AXISGATE_BINARY_DIR "/" + std::string(below); }

}  // namespace axisgate::test
