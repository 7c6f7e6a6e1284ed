// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/from_form.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_node.hpp"
#include "gateway/profile/make/eds_questions.hpp"
#include "gateway/profile/make/form_units.hpp"
#include "gateway/profile/make/profile_text.hpp"
#include "gateway/profile/make/take_out.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

constexpr std::string_view kRtu = "modbus-rtu";

/// One more than the last register.
int end_of(const FormRow& row) { return row.address.index + row.registers(); }

/// Registers behind one another that can be read, and how many they are at most.
struct Runs {
  json list = json::array();
  int longest = 2;
};

Runs runs_of(const Form& form) {
  constexpr int kMost = 125;
  Runs out;
  int first = -1, end = -1;
  const auto close = [&] {
    if (end - first < 2) return;
    out.list.push_back({first, end - 1});
    out.longest = std::min(std::max(out.longest, end - first), kMost);
  };
  for (const FormRow& row : form.rows) {
    if (!row.reads) continue;
    if (row.address.index != end) {
      close();
      first = row.address.index;
    }
    end = end_of(row);
  }
  close();
  return out;
}

/// Two reads of different lengths; empty: the table has none.
json reads_of(const Form& form) {
  const auto readable = [&](int registers) {
    return std::ranges::find_if(form.rows,
                                [&](const FormRow& row) { return row.reads && row.registers() == registers; });
  };
  for (const FormRow& row : form.rows) {
    const bool followed = std::ranges::any_of(
        form.rows, [&](const FormRow& next) { return next.reads && next.address.index == end_of(row); });
    if (row.reads && row.registers() == 1 && followed) return {{{"object", row.name}, {"counts", {1, 2}}}};
  }
  const auto one = readable(1), two = readable(2);
  if (one == form.rows.end() || two == form.rows.end()) return json::array();
  return {{{"object", one->name}, {"counts", {1}}}, {{"object", two->name}, {"counts", {2}}}};
}

/// How this table is read over Modbus: laid over what `protocol` says already.
void fit_protocol(const Form& form, json& protocol, MadeProfile& out) {
  const Runs runs = runs_of(form);
  protocol["runs"] = runs.list;
  protocol["max_registers"] = runs.longest;
  if (runs.longest > 2)
    out.notes.push_back(fmt::format(
        "one read goes over {} registers at most: max_registers, where the manual allows fewer", runs.longest));
  protocol["resynchronisation"] = reads_of(form);
  if (protocol["resynchronisation"].empty())
    out.faults.emplace_back(
        "needs two registers in a row that can be read, or one of 16 and one of 32 bits: replies are told apart by "
        "their length");
}

void add_object(const FormRow& row, json& document) {
  json object = {{"type", row.type()}, {"at", {{kRtu, row.address.index}}}};
  if (row.writes) object["access"] = row.reads ? "rw" : "wo";
  if (row.low && row.high) object["range"] = {*row.low, *row.high};
  document["objects"][row.name] = std::move(object);
}

/// "actual_position" is "position_actual" as well.
std::optional<Quantity> quantity_of(const std::string& name) {
  constexpr std::string_view kActual = "actual_";
  if (const auto quantity = quantity_named(name)) return quantity;
  return name.starts_with(kActual) ? quantity_named(name.substr(kActual.size()) + "_actual") : std::nullopt;
}

/// The gateway makes these of a virtual drive itself.
bool is_emulated(Quantity quantity) {
  return quantity == Quantity::statusword || quantity == Quantity::controlword || quantity == Quantity::mode ||
         quantity == Quantity::mode_display;
}

json entry_of(Quantity quantity, const FormRow& row) {
  if (quantity == Quantity::digital_inputs || quantity == Quantity::digital_outputs ||
      quantity == Quantity::vendor_error) {
    constexpr int kFirstFree = 4, kSixteen = 16;
    const bool is_error = quantity == Quantity::vendor_error;
    const int count = is_error ? 8 * row.width.size : std::min(8 * row.width.size, kSixteen - kFirstFree);
    return {{"bits", {{{"object", row.name}, {"count", count}, {"to", is_error ? 0 : kFirstFree}}}}};
  }
  return {{"object", row.name}};
}

json unit_entry(const FormUnit& unit) {
  json out = {{"base", unit.base}};
  json mul = json::array();
  if (unit.counts) mul.push_back("position_units_per_rev");
  if (unit.each.denominator() != 1) mul.push_back(unit.each.denominator());
  if (!mul.empty()) out["mul"] = std::move(mul);
  if (unit.each.numerator() != 1) out["div"] = {unit.each.numerator()};
  return out;
}

/// Objects, units and quantities of all rows.
void add_rows(const Form& form, json& document, MadeProfile& out) {
  for (const FormRow& row : form.rows) {
    add_object(row, document);
    const FormUnit unit = form_unit(row.unit);
    const auto quantity = quantity_of(row.name);
    const Kind kind = quantity ? axisgate::row(*quantity).kind : Kind::code;
    const bool fits = !quantity || kind == unit.kind;
    if (!row.unit.empty() && unit.kind != Kind::code && fits) {
      document["units"][unit.name] = unit_entry(unit);
      document["objects"][row.name]["unit"] = unit.name;
      if (unit.counts)
        document["constants"]["position_units_per_rev"] = {{"range", {1, 4294967295}}, {"unit", "units/rev"}};
    } else if (!row.unit.empty()) {
      document["objects"][row.name]["text"] = row.unit;
    }
    if (!quantity || is_emulated(*quantity)) continue;
    if (kind != unit.kind)
      out.notes.push_back(
          fmt::format("line {}: {} is no quantity: \"{}\" is no unit of its kind", row.line, row.name, row.unit));
    else if (!document["quantities"].contains(axisgate::row(*quantity).name))
      document["quantities"][std::string(axisgate::row(*quantity).name)] = entry_of(*quantity, row);
  }
}

const FormRow* find(const Form& form, std::string_view name) {
  const auto row = std::ranges::find(form.rows, name, &FormRow::name);
  return row == form.rows.end() ? nullptr : &*row;
}

/// What a form of commands is made of; a fault for each that is not there.
void require_rows(const Form& form, MadeProfile& out) {
  const FormRow* const control = find(form, "control");
  const FormRow* const status = find(form, "status");
  const FormRow* const fault = find(form, "fault");
  if (control == nullptr || !control->writes)
    out.faults.emplace_back("needs a row \"control\", rw or wo: what is written to enable, start and stop");
  if (status == nullptr || !status->reads)
    out.faults.emplace_back("needs a row \"status\" that can be read: whether the motor is enabled and moves");
  if (fault == nullptr || !fault->reads)
    out.faults.emplace_back("needs a row \"fault\" that can be read: 0 where there is none");
}

json write_control(std::int64_t value) { return {{"write", "control"}, {"value", value}}; }

/// Numbers that stand for the right ones until somebody has answered: one after the other, from the first that control
/// takes.
enum Placeholder : std::int64_t { kOff, kEnable, kQuickStop, kReset, kMove, kRun, kTurn };

void add_commands(json& document, std::int64_t first) {
  const json& quantities = document["quantities"];
  const json stands = {
      {"wait", "status"}, {"mask", "0x0002"}, {"equals", 0}, {"ms", 5000}, {"text", "the motor stands"}};
  json& commands = document["commands"];
  commands["enable"] = {
      {"steps",
       {write_control(first + kEnable), {{"wait", "status"}, {"mask", "0x0001"}, {"equals", 1}, {"ms", 1000}}}}};
  commands["disable"] = {
      {"steps", {write_control(first + kOff), {{"wait", "status"}, {"mask", "0x0001"}, {"equals", 0}, {"ms", 5000}}}}};
  commands["quick_stop"] = {{"steps", {write_control(first + kQuickStop), stands}}};
  commands["fault_reset"] = {
      {"steps", {write_control(first + kReset), {{"wait", "fault"}, {"equals", 0}, {"ms", 2000}}}}};
  json zeros = json::array();
  const auto start = [&](const char* mode, const char* target, const char* command, Placeholder value) {
    if (!quantities.contains(target)) return;
    document["modes"][mode] = whole_number(mode).value_or(0);
    commands[command] = {{"steps", {write_control(first + value)}}};
    if (std::string_view(target) != "target_position") zeros.push_back(quantities[target]["object"]);
  };
  document["modes"] = json::object();
  start("1", "target_position", "move_absolute", kMove);
  start("3", "target_velocity", "run_velocity", kRun);
  start("4", "target_torque", "run_torque", kTurn);
  document["state"] = {{"model", "virtual"},
                       {"quick_stop_ends", "energised"},
                       {"enabled", {{"object", "status"}, {"mask", "0x0001"}, {"equals", 1}}},
                       {"fault", {{"object", "fault"}, {"not_equals", 0}}},
                       {"moving", {{"object", "status"}, {"mask", "0x0002"}, {"equals", "0x0002"}}}};
  if (!zeros.empty()) document["state"]["zero_before_enable"] = zeros;
}

void ask_commands(json& document) {
  const auto ask = [&](const std::string& of, const std::string& text, const std::string& where) {
    add_question(document, {of, text, where, {"enable"}});
  };
  ask("/state", "Which bits of status say that the motor is enabled and that it moves? Here: bit 0 and bit 1.",
      "manual: 'status', 'motion state', 'running'");
  ask("/state/quick_stop_ends", "After a quick stop, does the motor hold torque (energised) or not (torque_off)?",
      "manual: 'emergency stop', 'quick stop'");
  for (const auto& [command, what] : std::to_array<std::pair<const char*, const char*>>(
           {{"enable", "enables the motor"},
            {"disable", "takes the torque away"},
            {"quick_stop", "stops the motor as fast as it can, and what tells that it stands"},
            {"fault_reset", "resets a fault"},
            {"move_absolute", "starts a move to target_position"},
            {"run_velocity", "starts turning at target_velocity"},
            {"run_torque", "starts turning by target_torque"}}))
    if (document["commands"].contains(command))
      ask(fmt::format("/commands/{}", command),
          fmt::format("Which number in control {}? The one here stands for it.", what),
          "manual: 'control register', 'command', 'trigger', 'jog', 'enable'");
}

/// Facts of the protocol that no table of registers has.
void ask_protocol(const Form& form, json& document) {
  const std::string at = fmt::format("/protocols/{}", kRtu);
  if (std::ranges::any_of(form.rows, [](const FormRow& row) { return row.registers() == 2; }))
    add_question(document, {at + "/word_order",
                            "Which register of a 32-bit value comes first, the high or the low half?",
                            "manual: '32-bit', 'high word', an example of a read position",
                            {"enable"}});
  add_question(document, {at + "/loss",
                          "Does the drive stop by itself when nobody talks to it?",
                          "manual: 'communication timeout', 'watchdog', 'offline'",
                          {}});
  add_question(document, {"/nvm",
                          "Does each write wear out the drive's memory (yes) or only a save (no)?",
                          "manual: 'EEPROM', 'save', 'power down'",
                          {}});
}

void finish(const json& base, json document, const FromEds& what, MadeProfile& out) {
  out.questions = question_lines(document);
  if (!out.faults.empty()) return;
  json inherited = base;
  for (const char* const key : {"$schema", "name", "base_only", "tried", "nvm"}) inherited.erase(key);
  for (const char* const key : {"$schema", "name", "base_only"}) document.erase(key);
  json made = inherited.empty() ? document : difference(inherited, document);
  made["profile"] = 1;
  made["name"] = what.name;
  if (!what.base.empty()) made["extends"] = what.base;
  out.text = profile_text(made);
}

void title(const FromEds& what, json& document) {
  document["title"] = what.name;
  document["source"] = "table " + plain_text(what.file);
  document["nvm"] = "unknown";
  document["tried"] = "simulated";
}

}  // namespace

MadeProfile profile_from_form(const Form& form, const FromEds& what) {
  MadeProfile out;
  json document = {{"protocols", {{kRtu, {{"worst_reply_ms", 500}, {"word_order", "high-first"}, {"loss", nullptr}}}}},
                   {"objects", json::object()},
                   {"quantities", json::object()}};
  title(what, document);
  fit_protocol(form, document["protocols"][std::string(kRtu)], out);
  add_rows(form, document, out);
  require_rows(form, out);
  if (!out.faults.empty()) return out;
  const FormRow& control = *find(form, "control");
  const std::int64_t first = std::max<std::int64_t>(control.low.value_or(0), 0);
  if (control.high && *control.high < first + kTurn) document["objects"]["control"].erase("range");
  document["objects"]["control"]["trigger"] = true;
  document["objects"]["control"]["mailbox"] = "read";
  add_commands(document, first);
  ask_commands(document);
  if (document.contains("constants"))
    add_question(document, {"position_units_per_rev",
                            "How many counts of the position does one turn of the motor's shaft have?",
                            "manual: 'pulses per revolution', 'microstep', 'electronic gear'",
                            {"position"}});
  ask_protocol(form, document);
  finish(json::object(), std::move(document), what, out);
  return out;
}

MadeProfile profile_like(const Form& form, const json& sibling, const FromEds& what) {
  MadeProfile out;
  json document = sibling;
  title(what, document);
  if (!document.contains("protocols") || !document["protocols"].contains(kRtu)) {
    out.faults.push_back(fmt::format("\"{}\" has no modbus-rtu", what.base));
    return out;
  }
  std::vector<std::string> names;
  for (const auto& [name, object] : sibling["objects"].items()) names.push_back(name);
  for (const std::string& name : names) {
    if (find(form, name) != nullptr) continue;
    take_out_object(document, name);
    out.notes.push_back(fmt::format("without {}: no row of this name", name));
  }
  for (const FormRow& row : form.rows) {
    json& object = document["objects"][row.name];
    if (object.is_null()) continue;
    object["type"] = row.type();
    object["at"][std::string(kRtu)] = row.address.index;
    object["access"] = !row.writes ? "ro" : row.reads ? "rw" : "wo";
    if (row.low && row.high) object["range"] = {*row.low, *row.high};
  }
  Form added;
  for (const FormRow& row : form.rows)
    if (document["objects"][row.name].is_null()) added.rows.push_back(row);
  add_rows(added, document, out);
  fit_protocol(form, document["protocols"][std::string(kRtu)], out);
  for (const char* const command : {"enable", "disable", "quick_stop"})
    if (!document["commands"].contains(command))
      out.faults.push_back(
          fmt::format("needs the rows that {} of \"{}\" uses: give them its names", command, what.base));
  for (const char* const condition : {"enabled", "fault", "moving"})
    if (document["state"].value("model", "") == "virtual" && !document["state"].contains(condition))
      out.faults.push_back(
          fmt::format("needs the row that \"{}\" of \"{}\" looks at: give it its name", condition, what.base));
  take_out_modes(document);
  add_question(document, {"/commands",
                          fmt::format("Are commands and state of {} this drive's too, word for word?", what.base),
                          "manuals of both: 'control', 'status', 'alarm'",
                          {"enable"}});
  finish(sibling, std::move(document), what, out);
  return out;
}

Eds eds_of(const Form& form) {
  static constexpr std::array<std::array<EdsType, 5>, 2> kTypes{{{0, 0x05, 0x06, 0, 0x07}, {0, 0x02, 0x03, 0, 0x04}}};
  Eds out;
  for (const FormRow& row : form.rows) {
    EdsObject object;
    object.section = fmt::format("{:04X}.{:02X}", row.address.index, row.address.sub);
    object.name = row.name;
    object.type = kTypes[row.width.is_signed ? 1 : 0][row.width.size];
    object.access = !row.writes ? "ro" : row.reads ? "rw" : "wo";
    object.low = row.low;
    object.high = row.high;
    out.objects.emplace(row.address, std::move(object));
  }
  return out;
}

}  // namespace axisgate::profile
