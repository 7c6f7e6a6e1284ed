// SPDX-License-Identifier: Apache-2.0
// What a drive's fault is, in words: its profile's row of the first fault word that is set, else the class of its
// error_code. Promises a text and a remedy for every fault. Never takes a code that is not valid now for the cause.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

struct FaultText {
  std::string text;
  std::string cause;
  std::string remedy;
};
/// Of a code by itself, of a drive of this profile (empty: of any); all empty: it is of no class.
[[nodiscard]] FaultText fault_text(const Picture& picture, const std::string& profile, std::uint32_t code);
/// Of the fault that the axis has now.
[[nodiscard]] FaultText fault_text(const Picture& picture, const AxisPicture& axis);
/// Member `fault`; null: there is none.
[[nodiscard]] nlohmann::ordered_json fault_json(const Picture& picture, const AxisPicture& axis, const Now& now);

}  // namespace axisgate::web
