# SPDX-License-Identifier: Apache-2.0
# The file FROM as the C++ source TO.
include(${CMAKE_CURRENT_LIST_DIR}/bytes.cmake)
bytes_of(${FROM} numbers)
file(WRITE ${TO} "// Made from openapi.json.
#include \"gateway/upstream/web_process/api/openapi_text.hpp\"
namespace axisgate::web {
namespace {
constexpr unsigned char kOpenapiBytes[] = {${numbers}};
}
std::string_view openapi_text() { return {reinterpret_cast<const char*>(kOpenapiBytes), sizeof(kOpenapiBytes)}; }
}
")
