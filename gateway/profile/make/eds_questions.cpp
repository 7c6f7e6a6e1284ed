// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/eds_questions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_node.hpp"
#include "gateway/profile/make/eds_objects.hpp"
#include "gateway/profile/make/take_out.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

constexpr std::uint16_t kEncoderResolution = 0x608F, kFeed = 0x6092, kSupportedModes = 0x6502, kStore = 0x1010;
constexpr std::uint16_t kQuickStopOption = 0x605A;

/// Of the constants by which a CiA 402 drive counts.
const std::vector<Question>& unit_questions() {
  static const std::vector<Question> kQuestions{
      {"position_units_per_rev",
       "How many counts of the position does one turn of the motor's shaft have?",
       "manual: 'encoder resolution', 'position factor', 'position units'; 608Fh, 6091h, 6092h",
       {"position"}},
      {"speed_units_per_rpm",
       "How many counts of 606Ch, 6081h and 60FFh are 1 rpm of the motor?",
       "manual: 'velocity units', 'velocity factor', SI unit velocity; 60A9h",
       {"position", "velocity"}},
      {"acceleration_units_per_rpm_per_s",
       "How many counts of 6083h and 6084h are 1 rpm per second?",
       "manual: 'acceleration units', 'acceleration factor', SI unit acceleration; 60AAh",
       {"position", "velocity"}},
  };
  return kQuestions;
}

/// So few counts a turn are what a drive holds until somebody has set it.
bool is_unset(const Eds& eds, std::uint16_t index) {
  constexpr std::int64_t kFewest = 16;
  const EdsObject* const counts = eds.find({index, 1});
  const EdsObject* const turns = eds.find({index, 2});
  if (counts == nullptr || !counts->value) return false;
  const std::int64_t divisor = turns == nullptr ? 1 : std::max<std::int64_t>(turns->value.value_or(1), 1);
  return *counts->value < kFewest * divisor;
}

void forget_unset(const Eds& eds, json& wanted) {
  std::vector<std::string> names;
  for (const auto& [name, object] : wanted["objects"].items()) {
    const auto address = canopen_address(object);
    const bool counts =
        address && (address->index == kEncoderResolution || address->index == kFeed) && address->sub == 1;
    if (counts && is_unset(eds, address->index)) names.push_back(name);
  }
  for (const std::string& name : names) hide_values(wanted, name);
}

/// Nobody but the configuration can give it.
bool is_open(const json& constant) {
  return constant.is_object() && !constant.contains("default") && !constant.contains("first");
}

/// What a rule's operand is, as far as the EDS has its number.
std::optional<std::int64_t> number_of(const Eds& eds, const json& wanted, const json& operand) {
  const JsonNode node(operand, "");
  if (const auto whole = node.whole()) return whole;
  const json& objects = wanted["objects"];
  const auto address = objects.contains(node.text()) ? canopen_address(objects[node.text()]) : std::nullopt;
  const EdsObject* const object = address ? eds.find(*address) : nullptr;
  return object == nullptr ? std::nullopt : object->value;
}

/// None: the EDS does not say.
std::optional<bool> holds(const Eds& eds, const json& wanted, const json& condition) {
  if (!condition.is_array() || condition.empty()) return true;  // a rule without a condition
  if (condition[0].is_array()) {
    for (const json& part : condition)
      if (const auto one = holds(eds, wanted, part); one != true) return one;
    return true;
  }
  if (condition.size() == 2) return wanted["objects"].contains(JsonNode(condition[0], "").text());
  const auto left = number_of(eds, wanted, condition[0]), right = number_of(eds, wanted, condition[2]);
  if (!left || !right) return std::nullopt;
  return (*left == *right) == (condition[1] == "==");
}

/// By the numbers of the EDS no rule tells it.
bool is_unknown_there(const Eds& eds, const json& wanted, const json& constant) {
  for (const json& rule : constant.value("first", json::array())) {
    const auto applies = holds(eds, wanted, rule.value("if", json()));
    if (!applies) return false;
    if (*applies) return rule.value("value", json()) == "unknown";
  }
  return false;
}

/// A constant that the drive may give by other settings than those of the EDS is asked for as well: it may have them.
void ask_constants(const Eds& eds, json& wanted) {
  const json constants = wanted.value("constants", json::object());
  for (const auto& [name, constant] : constants.items()) {
    if (!is_open(constant) && !is_unknown_there(eds, wanted, constant)) continue;
    const auto known = std::ranges::find(unit_questions(), name, &Question::of);
    if (known != unit_questions().end()) {
      add_question(wanted, *known);
      continue;
    }
    add_question(
        wanted,
        {name, "What is " + name + "? " + constant.value("text", ""), "the drive's manual", {"position", "velocity"}});
  }
}

void ask_facts(const Eds& eds, json& wanted) {
  if (!eds.has_index(kQuickStopOption)) {
    wanted["state"].erase("quick_stop_ends");
    add_question(wanted, {"/state/quick_stop_ends",
                          "After a quick stop, does the motor hold torque (energised) or not (torque_off)?",
                          "manual: 'quick stop', 'quick stop option code'",
                          {}});
  }
  const json loss = wanted["protocols"]["canopen"].value("loss", json());
  if (loss.is_object() && loss.value("reaction", "stop") != "stop")
    add_question(wanted, {"/protocols/canopen/loss/reaction",
                          "Does the motor stop when the drive misses the gateway?",
                          "manual: 'heartbeat error', 'abort connection option code', 'node guarding'; 6007h, 1029h",
                          {}});
  const EdsObject* const modes = eds.find({kSupportedModes, 0});
  if (modes == nullptr || modes->value.value_or(0) == 0)
    add_question(wanted, {"/modes",
                          "Which modes does the drive have? The EDS does not say.",
                          "manual: 'modes of operation', 'supported drive modes'; 6502h",
                          {}});
  if (eds.has_index(kStore) && !wanted["commands"].contains("save_parameters"))
    add_question(
        wanted,
        {"/commands/save_parameters",
         "What saves the parameters, and may the motor be enabled then? Without an answer there is no such command.",
         "manual: 'store parameters', 'save'; 1010h",
         {}});
  add_question(wanted, {"/nvm",
                        "Does each write wear out the drive's memory (yes) or only a save (no)?",
                        "manual: 'non-volatile memory', 'EEPROM', 'flash'",
                        {}});
}

}  // namespace

void add_question(json& document, const Question& question) {
  json& list = document["ask"];
  if (!list.is_array()) list = json::array();
  const auto same = [&](const json& known) { return known.is_object() && known.value("of", "") == question.of; };
  if (std::any_of(list.begin(), list.end(), same)) return;
  list.push_back(
      {{"of", question.of}, {"text", question.text}, {"where", question.where}, {"before", question.before}});
}

std::vector<std::string> question_lines(const json& document) {
  std::vector<std::string> out;
  for (const json& entry : document.value("ask", json::array())) {
    const auto before = entry.value("before", std::vector<std::string>{});
    out.push_back(fmt::format("{}: {} ({}){}", entry.value("of", ""), entry.value("text", ""), entry.value("where", ""),
                              before.empty() ? "" : fmt::format("; until then no {}", fmt::join(before, ", no "))));
  }
  return out;
}

void ask_questions(const Eds& eds, json& wanted, std::vector<std::string>& questions) {
  forget_unset(eds, wanted);
  drop_hidden_rules(wanted);
  ask_constants(eds, wanted);
  ask_facts(eds, wanted);
  questions = question_lines(wanted);
}

}  // namespace axisgate::profile
