// SPDX-License-Identifier: Apache-2.0
// Numbers of a drive that only the drive itself tells (profile: a constant's "first"), and what waits for them.
// Promises exact numbers or none: a rule that cannot be judged gives no value, and so does a number that the constant
// cannot be. Never reads, and holds no state.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/rational.hpp"
#include "gateway/model/object_def.hpp"

namespace axisgate::model {

/// A number that must be read from the drive (profile: a constant's "first"): what the first rule says whose conditions
/// all hold.
struct DriveConstant {
  struct Operand {
    ObjectId object = kNoObject;  ///< kNoObject: `number`
    Rational number{1};
  };
  struct Condition {
    enum class Test : std::uint8_t { equal, not_equal, present } test{};
    Operand left, right;  ///< present: `left` alone, an object that the drive has
  };
  struct Rule {
    std::vector<Condition> conditions;  ///< the later ones are only judged where those before hold
    bool unknown = false;               ///< nobody knows the value then
    std::vector<Operand> mul, div;      ///< else it is their product
  };
  std::string name;
  std::vector<Rule> rules;
  std::optional<Rational> min, max;
};

/// What of a binding's scale and limits waits for constants that are read from the drive: raw_per_unit is made as
/// fixed * product(mul) / product(div), and the limits again from it. Without any, the binding is whole from the start.
struct ScaleRecipe {
  Rational fixed{1};
  std::vector<std::size_t> mul, div;    ///< positions in DriveModel::constants
  Range raw;                            ///< what the object takes
  Range allowed{INT64_MIN, INT64_MAX};  ///< register units: profile and axis limits, and the register's type
  [[nodiscard]] bool waits() const { return !mul.empty() || !div.empty(); }
};

/// What the drive holds in an object; no value: it is not known.
using NumberOf = std::function<std::optional<std::int64_t>(ObjectId)>;
/// The drive has refused the object: it does not have it. Empty: it was asked for none.
using IsAbsent = std::function<bool(ObjectId)>;

/// The number of a constant by what the drive holds, or why there is none.
struct Evaluated {
  enum class Why : std::uint8_t {
    known,
    absent,    ///< a rule needs `object`, which the drive does not have
    not_read,  ///< a rule needs `object`, and nobody knows what it holds
    no_rule,   ///< the rule that holds says so, or none holds
    unusable,  ///< it comes to what the constant cannot be
  };
  std::optional<Rational> value;
  Why why = Why::known;
  ObjectId object = kNoObject;
};
[[nodiscard]] Evaluated evaluate(const DriveConstant& constant, const NumberOf& number_of,
                                 const IsAbsent& is_absent = {});
/// What its rules name, each object once.
[[nodiscard]] std::vector<ObjectId> objects_of(const DriveConstant& constant);

}  // namespace axisgate::model
