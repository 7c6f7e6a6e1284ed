// SPDX-License-Identifier: Apache-2.0
// A capture as the bytes of a file, and back. Pure: bytes and captures.
// Promises that what is read back is what was written, and that a file of another version, a half-written one and one
// that was never a capture are refused with the reason. Never takes more from a file than is in it.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/core/bytes.hpp"
#include "gateway/upstream/web_process/capture/capture.hpp"

namespace axisgate::web {

/// Behind the id, in its file's name.
inline constexpr std::string_view kCaptureSuffix = ".capture";

[[nodiscard]] std::vector<Byte> file_of(const Capture& capture);
/// Or what is wrong with it.
[[nodiscard]] std::variant<Capture, std::string> capture_of(Bytes file);

}  // namespace axisgate::web
