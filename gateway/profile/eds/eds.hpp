// SPDX-License-Identifier: Apache-2.0
// An EDS or DCF (CiA 306-1): the maker's own list of a drive's CANopen objects, as far as a profile can be made from it
// or held against it. Promises to read what such files are in practice: any case of names, any way to write a number,
// $NODEID formulas, compact arrays, foreign characters, things given twice. Each oddity is a remark with its line and
// what was taken; it makes unclear only the one object that depends on it. Never opens a file, never guesses a value it
// cannot read, and never keeps more than kMaxEdsObjects.
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
inline constexpr std::size_t kMaxEdsRemarks = 1000;  ///< that are kept; the others are counted

/// CiA 301 table 44; 0 where the file says none.
using EdsType = std::uint16_t;

struct EdsObject {
  std::string section;  ///< as written: "6099sub1"
  std::string name;
  EdsType type = 0;
  std::string access;                     ///< in small letters; empty where the file says none
  std::optional<std::int64_t> low, high;  ///< none where the file has none, a formula, or two that exclude all numbers
  std::optional<std::int64_t> value;      ///< ParameterValue of a DCF, else DefaultValue, of a whole number
  bool mappable = false;
  std::string unclear;  ///< why type or access cannot be relied on; empty: they can
};

struct EdsFault {
  std::size_t line = 0;  ///< from 1; 0: the whole file
  std::string message;
  friend bool operator==(const EdsFault&, const EdsFault&) = default;
};

struct Eds {
  std::string vendor_name, product_name;
  std::string version;  ///< of the file, as the maker counts; empty where the file says none
  std::optional<std::int64_t> vendor, product, revision;
  std::map<ObjectAddress, EdsObject> objects;
  std::vector<EdsFault> faults;   ///< why this is no EDS at all
  std::vector<EdsFault> remarks;  ///< oddities, in the order of the file
  std::size_t remarks_in_all = 0;

  /// Of more than kMaxEdsRemarks only the number is kept.
  void remark(std::size_t line, std::string message);
  /// Null: there is none.
  [[nodiscard]] const EdsObject* find(ObjectAddress address) const;
  /// Whether it has any sub-index of it.
  [[nodiscard]] bool has_index(std::uint16_t index) const;
};

[[nodiscard]] Eds parse_eds(std::string_view text);

/// Bytes of a number of this type, and whether it has a sign; none: no whole number of 1, 2 or 4 bytes, and no REAL32.
struct EdsWidth {
  std::uint8_t size = 0;
  bool is_signed = false;
  bool is_real = false;
};
[[nodiscard]] std::optional<EdsWidth> width_of(EdsType type);
/// "UNSIGNED16"; "type 0x0040" of what CiA 301 does not name.
[[nodiscard]] std::string eds_type_name(EdsType type);

}  // namespace axisgate::profile
