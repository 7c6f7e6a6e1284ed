// SPDX-License-Identifier: Apache-2.0
// Sections "alarms", "checks" and "setup".
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::size_t kFaultWords = 2;

/// The alarms that a check may raise: the others have their own makers.
constexpr auto kCheckAlarms = names_of<AxisAlarm>({{AxisAlarm::identity_mismatch, "identity_mismatch"},
                                                   {AxisAlarm::local_control, "local_control"},
                                                   {AxisAlarm::limit_inputs_open, "limit_inputs_open"},
                                                   {AxisAlarm::stop_options, "stop_options"}});

/// What one section of alarms has in common.
struct AlarmTable {
  std::string remedy;           ///< of rows that give none
  std::set<std::string> known;  ///< what makes a row active, of all rows
};

void read_alarm(Reading& reading, const JsonNode& node, AlarmTable& table) {
  AlarmSpec out;
  const std::int64_t word = node.whole("word", 0);
  out.word = static_cast<std::uint8_t>(word);
  if (node.has("bit") == node.has("value"))
    return reading.fault(node.pointer(),
                         "an alarm is active by its \"bit\" or by a \"value\" of the word: give one of them");
  std::string active;
  if (node.has("bit")) {
    out.bit = static_cast<std::uint8_t>(node.whole("bit", 0));
    active = fmt::format("bit {}", *out.bit);
  } else {
    out.value = static_cast<std::uint32_t>(node.whole("value", 0));
    active = fmt::format("value {}", *out.value);
  }
  const std::vector<std::string>& words = reading.profile.fault_words;
  if (static_cast<std::size_t>(word) >= words.size()) {
    reading.fault(node.pointer("word"), "there is no fault word {} under /alarms/words", word);
  } else {
    reading.each_meaning(words[out.word], [&](const Object& object) {
      if (out.bit && *out.bit >= 8 * object.type.size)
        reading.fault(node.pointer("bit"), "reaches beyond the {} bits of object \"{}\"", 8 * object.type.size,
                      object.name);
      if (out.value) reading.needs_number(object, *out.value, node.pointer("value"));
    });
  }
  if (!table.known.insert(fmt::format("{} {}", word, active)).second)
    reading.fault(node.pointer(), "{} of word {} has a row already", active, word);
  out.code = static_cast<std::uint16_t>(node.whole("code", 0));
  out.text = node.text("text");
  out.remedy = node.has("remedy") ? node.text("remedy") : table.remedy;
  if (out.remedy.empty())
    reading.fault(node.pointer(), "says no \"remedy\", and neither does \"alarms\" for all its rows");
  reading.profile.alarms.push_back(std::move(out));
}

/// "codes": the first fault word is a CiA 402 error code itself.
void read_codes(Reading& reading, const JsonNode& codes, AlarmTable& table) {
  for (const JsonNode& told : codes.members()) {
    nlohmann::json row{{"value", told.key()}, {"code", told.key()}};
    const std::vector<JsonNode> texts = told.elements();
    if (texts.size() == 2) row["remedy"] = texts[1].text();
    row["text"] = texts.size() == 2 ? texts[0].text() : told.text();
    read_alarm(reading, JsonNode(row, told.pointer()), table);
  }
}

/// "instead_of": then the amount may wait for the drive, which is read before anything is written.
void read_instead_of(Reading& reading, const JsonNode& node, WriteSpec& out) {
  const JsonNode factory = node["instead_of"];
  if (!factory.is_array()) return;
  out.instead_of = numbers_in(factory);
  if (out.values.size() > 1) reading.fault(factory.pointer(), "needs one value for all axes");
  reading.each_meaning(out.object, [&](const Object& object) {
    reading.needs_readable(object, factory.pointer(), ", so nobody knows what it holds");
    for (const std::int64_t raw : out.instead_of) reading.needs_number(object, raw, factory.pointer());
  });
}

}  // namespace

WriteSpec read_write(Reading& reading, const JsonNode& node) {
  WriteSpec out;
  out.pointer = node.pointer();
  out.object = node.text("write");
  out.on = node.names("on");
  out.why = node.text("why");
  out.values = reading.values(node["value"]);
  reading.each_named(out.object, node.pointer("write"), [&](const Object& object) {
    reading.needs_writable(object, node.pointer("write"));
    for (const ValueSpec& value : out.values) {
      if (std::holds_alternative<Quantity>(value) || std::holds_alternative<SetPositionValue>(value))
        reading.fault(node.pointer("value"), "only a command can write what a client asked for");
      else
        reading.value_fits(value, object, node.pointer("value"));
    }
    for (const std::string& protocol : out.on)
      if (reading.names_protocol(protocol, node.pointer("on")))
        reading.needs_address(object, protocol, node.pointer("on"));
  });
  return out;
}

void read_setup(Reading& reading) {
  for (const JsonNode& node : reading.document["setup"].elements()) {
    WriteSpec out = read_write(reading, node);
    read_instead_of(reading, node, out);
    reading.each_meaning(out.object, [&](const Object& object) {
      if (object.trigger)
        reading.fault(node.pointer(), "object \"{}\" is a trigger: setup must never start anything", object.name);
      if (!out.instead_of.empty()) return;
      for (const ValueSpec& value : out.values) reading.value_known(value, object, node.pointer("value"));
    });
    reading.profile.setup.push_back(std::move(out));
  }
}

void read_checks(Reading& reading) {
  std::set<std::string> names;
  for (const JsonNode& node : reading.document["checks"].elements()) {
    CheckSpec out;
    out.pointer = node.pointer();
    out.name = node.text("name");
    if (!out.name.empty() && !names.insert(out.name).second)
      reading.fault(node.pointer("name"), "check \"{}\" is given twice", out.name);
    out.bad = reading.condition(node, node.text("object"));
    out.alarm = kCheckAlarms.named(node.text("alarm")).value_or(out.alarm);
    out.text = node.text("text");
    for (const JsonNode& remedy : node["remedy"].elements()) out.remedy.push_back(read_write(reading, remedy));
    reading.profile.checks.push_back(std::move(out));
  }
}

void read_alarms(Reading& reading) {
  const JsonNode section = reading.document["alarms"];
  if (!section.is_object()) return;
  const std::vector<std::string> words = section.names("words");
  reading.profile.fault_words = words;
  if (words.size() > kFaultWords) reading.fault("/alarms/words", "vendor_error has room for two fault words");
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string at = section["words"][i].pointer();
    reading.each_named(words[i], at, [&](const Object& object) { reading.needs_readable(object, at); });
  }
  AlarmTable table{section.text("remedy"), {}};
  for (const JsonNode& row : section["rows"].elements()) read_alarm(reading, row, table);
  read_codes(reading, section["codes"], table);
  if (!section.has("rows") && !section.has("codes"))
    reading.fault("/alarms", "lists no fault: give \"rows\" or \"codes\"");
}

}  // namespace axisgate::profile
