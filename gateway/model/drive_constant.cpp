// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/drive_constant.hpp"

#include <algorithm>
#include <stdexcept>

namespace axisgate::model {
namespace {

using Operand = DriveConstant::Operand;
using ConditionTest = DriveConstant::Condition::Test;
using Why = Evaluated::Why;

class Evaluation {
 public:
  Evaluation(const DriveConstant& constant, const NumberOf& number_of, const IsAbsent& is_absent)
      : constant_(constant), number_of_(number_of), is_absent_(is_absent) {}

  Evaluated run() {
    for (const DriveConstant::Rule& rule : constant_.rules) {
      const std::optional<bool> applies = all_hold(rule.conditions);
      if (!applies) return missing_;
      if (!*applies) continue;
      return rule.unknown ? Evaluated{{}, Why::no_rule} : product(rule);
    }
    return {{}, Why::no_rule};
  }

 private:
  /// No value: it cannot be judged.
  std::optional<bool> all_hold(const std::vector<DriveConstant::Condition>& conditions) {
    for (const DriveConstant::Condition& each : conditions) {
      if (each.test == ConditionTest::present && absent(each.left)) return false;
      const auto left = number(each.left);
      if (!left) return std::nullopt;
      if (each.test == ConditionTest::present) continue;
      const auto right = number(each.right);
      if (!right) return std::nullopt;
      if ((*left == *right) != (each.test == ConditionTest::equal)) return false;
    }
    return true;
  }

  Evaluated product(const DriveConstant::Rule& rule) {
    Rational out(1);
    for (const auto* factors : {&rule.mul, &rule.div}) {
      for (const Operand& operand : *factors) {
        const auto factor = number(operand);
        if (!factor) return missing_;
        if (factors == &rule.div && factor->numerator() == 0) return {{}, Why::unusable};
        out = factors == &rule.div ? out / *factor : out * *factor;
      }
    }
    const double number = out.to_double();
    const bool beyond = (constant_.min && number < constant_.min->to_double()) ||
                        (constant_.max && number > constant_.max->to_double());
    return beyond ? Evaluated{{}, Why::unusable} : Evaluated{out};
  }

  [[nodiscard]] bool absent(const Operand& operand) const {
    return operand.object != kNoObject && is_absent_ && is_absent_(operand.object);
  }

  std::optional<Rational> number(const Operand& operand) {
    if (operand.object == kNoObject) return operand.number;
    if (const std::optional<std::int64_t> held = number_of_(operand.object)) return Rational(*held);
    missing_ = {{}, absent(operand) ? Why::absent : Why::not_read, operand.object};
    return std::nullopt;
  }

  const DriveConstant& constant_;
  const NumberOf& number_of_;
  const IsAbsent& is_absent_;
  Evaluated missing_;
};

}  // namespace

Evaluated evaluate(const DriveConstant& constant, const NumberOf& number_of, const IsAbsent& is_absent) {
  try {
    return Evaluation(constant, number_of, is_absent).run();
  } catch (const std::overflow_error&) {
    return {{}, Why::unusable};
  }
}

std::vector<ObjectId> objects_of(const DriveConstant& constant) {
  std::vector<ObjectId> out;
  const auto add = [&](const Operand& operand) {
    if (operand.object != kNoObject && std::ranges::find(out, operand.object) == out.end())
      out.push_back(operand.object);
  };
  for (const DriveConstant::Rule& rule : constant.rules) {
    for (const DriveConstant::Condition& each : rule.conditions) {
      add(each.left);
      add(each.right);
    }
    for (const auto* operands : {&rule.mul, &rule.div}) std::ranges::for_each(*operands, add);
  }
  return out;
}

}  // namespace axisgate::model
