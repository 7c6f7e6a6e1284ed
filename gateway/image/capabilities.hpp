// SPDX-License-Identifier: Apache-2.0
// What a drive has on its protocol: the quantities of register 20, those of them that can be written, and the commands
// of register 36. Promises that servers, map, check and admission ask in this one place whether an axis has a thing.
// Never says whether it may be asked for now, or by whom.
#pragma once

#include <cstdint>

#include "gateway/image/quantity.hpp"

namespace axisgate {

enum class Command : std::uint8_t;

struct Capabilities {
  std::uint32_t supported = 0;           ///< register 20: a bit for each quantity
  std::uint32_t writable = 0;            ///< quantities that can be written, as far as they are in `supported`
  std::uint32_t supported_commands = 0;  ///< register 36: a bit for each command's number

  [[nodiscard]] constexpr bool supports(Quantity quantity) const { return (supported & bit(quantity)) != 0; }
  [[nodiscard]] constexpr bool takes(Quantity quantity) const { return (supported & writable & bit(quantity)) != 0; }
  /// What no register value asks for, a coil's alone, is in no bit.
  [[nodiscard]] bool supports(Command command) const;
};

}  // namespace axisgate
