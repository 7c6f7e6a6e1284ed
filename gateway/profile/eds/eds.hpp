// SPDX-License-Identifier: Apache-2.0
// An EDS (electronic data sheet, CiA 306-1): the maker's own list of a drive's CANopen objects, as far as a profile can
// be held against it. Promises to read what such files are in practice: any case of names, hexadecimal, octal and
// decimal numbers, $NODEID formulas, compact arrays, foreign characters; and to name each line that it cannot read.
// Never opens a file, never guesses a value it cannot read, and never keeps more than kMaxEdsObjects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/bus/exchange.hpp"

namespace axisgate::profile {

inline constexpr std::size_t kMaxEdsBytes = std::size_t{4} << 20U;
inline constexpr std::size_t kMaxEdsObjects = 65536;
inline constexpr std::size_t kMaxEdsFaults = 20;  ///< a file that is none has enough after so many

/// CiA 301 table 44; 0 where the file says none.
using EdsType = std::uint16_t;

struct EdsObject {
  std::string section;  ///< as written: "6099sub1"
  std::string name;
  EdsType type = 0;
  std::string access;                     ///< in small letters; empty where the file says none
  std::optional<std::int64_t> low, high;  ///< none where the file has none, or a formula
  bool mappable = false;
};

struct EdsFault {
  std::size_t line = 0;  ///< from 1; 0: the whole file
  std::string message;
  friend bool operator==(const EdsFault&, const EdsFault&) = default;
};

struct Eds {
  std::string vendor_name, product_name;
  std::optional<std::int64_t> vendor, product, revision;
  std::map<ObjectAddress, EdsObject> objects;
  std::vector<EdsFault> faults;
};

[[nodiscard]] Eds parse_eds(std::string_view text);

/// Bytes of a whole number of this type, and whether it has a sign; none: no whole number of 1, 2 or 4 bytes.
struct EdsWidth {
  std::uint8_t size = 0;
  bool is_signed = false;
};
[[nodiscard]] std::optional<EdsWidth> width_of(EdsType type);
/// "UNSIGNED16"; "type 0x0040" of what CiA 301 does not name.
[[nodiscard]] std::string eds_type_name(EdsType type);

}  // namespace axisgate::profile
