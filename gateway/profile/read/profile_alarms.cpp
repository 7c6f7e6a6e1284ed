// SPDX-License-Identifier: Apache-2.0
// Sections "alarms", "checks" and "setup".
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::size_t kFaultWords = 2;

/// The alarms that a check may raise: the others have their own makers.
constexpr std::array<std::pair<std::string_view, AxisAlarm>, 4> kCheckAlarms{{
    {"identity_mismatch", AxisAlarm::identity_mismatch},
    {"local_control", AxisAlarm::local_control},
    {"limit_inputs_open", AxisAlarm::limit_inputs_open},
    {"stop_options", AxisAlarm::stop_options},
}};

/// What one section of alarms has in common.
struct AlarmTable {
  std::string remedy;           ///< of rows that give none
  std::set<std::string> known;  ///< what makes a row active, of all rows
};

void read_alarm(Reading& reading, const json& node, const std::string& pointer, AlarmTable& table) {
  AlarmSpec out;
  const std::int64_t word = whole_in(node, "word", 0);
  out.word = static_cast<std::uint8_t>(word);
  const json* bit = member(node, "bit");
  const json* value = member(node, "value");
  if ((bit == nullptr) == (value == nullptr))
    return reading.fault(pointer, "an alarm is active by its \"bit\" or by a \"value\" of the word: give one of them");
  std::string active;
  if (bit != nullptr) {
    out.bit = static_cast<std::uint8_t>(whole(*bit).value_or(0));
    active = "bit " + std::to_string(*out.bit);
  } else {
    out.value = static_cast<std::uint32_t>(whole(*value).value_or(0));
    active = "value " + std::to_string(*out.value);
  }
  const std::vector<std::string>& words = reading.profile.fault_words;
  if (static_cast<std::size_t>(word) >= words.size()) {
    reading.fault(pointer_to(pointer, "word"),
                  "there is no fault word " + std::to_string(word) + " under /alarms/words");
  } else {
    reading.each_meaning(words[out.word], [&](const Object& object) {
      if (out.bit && *out.bit >= 8 * object.type.size)
        reading.fault(pointer_to(pointer, "bit"), "reaches beyond the " + std::to_string(8 * object.type.size) +
                                                      " bits of object \"" + object.name + "\"");
      if (out.value && !object.numbers().holds(*out.value))
        reading.fault(pointer_to(pointer, "value"), std::to_string(*out.value) + " does not fit object \"" +
                                                        object.name + "\": it takes " + range_text(object.numbers()));
    });
  }
  if (!table.known.insert(std::to_string(word) + " " + active).second)
    reading.fault(pointer, active + " of word " + std::to_string(word) + " has a row already");
  const json* code = member(node, "code");
  out.code = static_cast<std::uint16_t>(code == nullptr ? 0 : whole(*code).value_or(0));
  out.text = text_in(node, "text");
  out.remedy = member(node, "remedy") == nullptr ? table.remedy : text_in(node, "remedy");
  if (out.remedy.empty()) reading.fault(pointer, "says no \"remedy\", and neither does \"alarms\" for all its rows");
  reading.profile.alarms.push_back(std::move(out));
}

/// "codes": the first fault word is a CiA 402 error code itself.
void read_codes(Reading& reading, const json& section, AlarmTable& table) {
  const json* codes = member(section, "codes");
  if (codes == nullptr || !codes->is_object()) return;
  for (const auto& [code, told] : codes->items()) {
    json row{{"value", code}, {"code", code}};
    if (told.is_array() && told.size() == 2) {
      row["text"] = told[0];
      row["remedy"] = told[1];
    } else {
      row["text"] = told;
    }
    read_alarm(reading, row, pointer_to("/alarms/codes", code), table);
  }
}

}  // namespace

WriteSpec read_write(Reading& reading, const json& node, const std::string& pointer) {
  WriteSpec out;
  out.pointer = pointer;
  out.object = text_in(node, "write");
  out.on = names_in(node, "on");
  out.why = text_in(node, "why");
  if (const json* value = member(node, "value")) out.values = reading.values(*value, pointer_to(pointer, "value"));
  if (!reading.names_object(out.object, pointer_to(pointer, "write"))) return out;
  reading.each_meaning(out.object, [&](const Object& object) {
    if (!object.writable) reading.fault(pointer_to(pointer, "write"), "object \"" + object.name + "\" is read-only");
    for (const ValueSpec& value : out.values) {
      if (std::holds_alternative<Quantity>(value) || std::holds_alternative<SetPositionValue>(value))
        reading.fault(pointer_to(pointer, "value"), "only a command can write what a client asked for");
      else
        reading.value_fits(value, object, pointer_to(pointer, "value"));
    }
    for (const std::string& protocol : out.on) {
      if (!reading.profile.protocols.contains(protocol))
        reading.fault(pointer_to(pointer, "on"), "protocol \"" + protocol + "\" is not under /protocols" +
                                                     did_you_mean(protocol, keys_in(reading.profile.protocols)));
      else if (!object.places.contains(protocol))
        reading.fault(pointer_to(pointer, "on"), "object \"" + object.name + "\" has no address on " + protocol);
    }
  });
  return out;
}

namespace {

/// "instead_of": then the amount may wait for the drive, which is read before anything is written.
void read_instead_of(Reading& reading, const json& node, WriteSpec& out) {
  const json* factory = member(node, "instead_of");
  if (factory == nullptr || !factory->is_array()) return;
  const std::string pointer = pointer_to(out.pointer, "instead_of");
  for (const json& number : *factory)
    if (const auto raw = whole(number)) out.instead_of.push_back(*raw);
  if (out.values.size() > 1) reading.fault(pointer, "needs one value for all axes");
  reading.each_meaning(out.object, [&](const Object& object) {
    if (!object.readable)
      reading.fault(pointer, "object \"" + object.name + "\" cannot be read, so nobody knows what it holds");
    for (const std::int64_t raw : out.instead_of)
      if (!object.numbers().holds(raw))
        reading.fault(pointer, std::to_string(raw) + " does not fit object \"" + object.name + "\": it takes " +
                                   range_text(object.numbers()));
  });
}

}  // namespace

void read_setup(Reading& reading) {
  const json* section = member(reading.document, "setup");
  if (section == nullptr || !section->is_array()) return;
  for (std::size_t i = 0; i < section->size(); ++i) {
    const std::string pointer = pointer_to("/setup", i);
    WriteSpec out = read_write(reading, (*section)[i], pointer);
    read_instead_of(reading, (*section)[i], out);
    reading.each_meaning(out.object, [&](const Object& object) {
      if (object.trigger)
        reading.fault(pointer, "object \"" + object.name + "\" is a trigger: setup must never start anything");
      if (!out.instead_of.empty()) return;
      for (const ValueSpec& value : out.values) reading.value_known(value, object, pointer_to(pointer, "value"));
    });
    reading.profile.setup.push_back(std::move(out));
  }
}

void read_checks(Reading& reading) {
  const json* section = member(reading.document, "checks");
  if (section == nullptr || !section->is_array()) return;
  std::set<std::string> names;
  for (std::size_t i = 0; i < section->size(); ++i) {
    const json& node = (*section)[i];
    const std::string pointer = pointer_to("/checks", i);
    CheckSpec out;
    out.pointer = pointer;
    out.name = text_in(node, "name");
    if (!out.name.empty() && !names.insert(out.name).second)
      reading.fault(pointer_to(pointer, "name"), "check \"" + out.name + "\" is given twice");
    out.bad = reading.condition(node, text_in(node, "object"), pointer);
    const std::string alarm = text_in(node, "alarm");
    for (const auto& [name, value] : kCheckAlarms)
      if (name == alarm) out.alarm = value;
    out.text = text_in(node, "text");
    if (const json* remedy = member(node, "remedy"); remedy != nullptr && remedy->is_array())
      for (std::size_t k = 0; k < remedy->size(); ++k)
        out.remedy.push_back(read_write(reading, (*remedy)[k], pointer_to(pointer_to(pointer, "remedy"), k)));
    reading.profile.checks.push_back(std::move(out));
  }
}

void read_alarms(Reading& reading) {
  const json* section = member(reading.document, "alarms");
  if (section == nullptr || !section->is_object()) return;
  reading.profile.fault_words = names_in(*section, "words");
  if (reading.profile.fault_words.size() > kFaultWords)
    reading.fault("/alarms/words", "vendor_error has room for two fault words");
  for (std::size_t i = 0; i < reading.profile.fault_words.size(); ++i) {
    const std::string at = pointer_to("/alarms/words", i);
    if (reading.names_object(reading.profile.fault_words[i], at))
      reading.each_meaning(reading.profile.fault_words[i], [&](const Object& object) {
        if (!object.readable) reading.fault(at, "object \"" + object.name + "\" cannot be read");
      });
  }
  AlarmTable table{text_in(*section, "remedy"), {}};
  if (const json* rows = member(*section, "rows"); rows != nullptr && rows->is_array())
    for (std::size_t i = 0; i < rows->size(); ++i)
      read_alarm(reading, (*rows)[i], pointer_to("/alarms/rows", i), table);
  read_codes(reading, *section, table);
  if (member(*section, "rows") == nullptr && member(*section, "codes") == nullptr)
    reading.fault("/alarms", "lists no fault: give \"rows\" or \"codes\"");
}

}  // namespace axisgate::profile
