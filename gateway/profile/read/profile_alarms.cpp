// SPDX-License-Identifier: Apache-2.0
// Sections "alarms", "checks" and "setup".
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

/// `known`: what makes a row active, of all rows before.
void read_alarm(Reading& reading, const JsonNode& node, std::set<std::string>& known) {
  if (node.has("bit") == node.has("value"))
    return reading.fault(node.pointer(),
                         "an alarm is active by its \"bit\" or by a \"value\" of the word: give one of them");
  const std::int64_t word = node.whole("word", 0), bit = node.whole("bit", 0), value = node.whole("value", 0);
  const bool by_bit = node.has("bit");
  const std::vector<std::string> words = reading.profile.fault_words();
  if (static_cast<std::size_t>(word) >= words.size()) {
    reading.fault(node.pointer("word"), "there is no fault word {} under /alarms/words", word);
  } else if (words[static_cast<std::size_t>(word)] == kEmergencyWord) {
    // What an EMCY carries is a CiA 402 error code already.
    if (by_bit || value != node.whole("code", 0))
      reading.fault(node.pointer(), "an EMCY carries the code itself: give its text under \"codes\"");
  } else {
    reading.each_meaning(words[static_cast<std::size_t>(word)], [&](const Object& object) {
      if (bit >= 8 * object.size)
        reading.fault(node.pointer("bit"), "reaches beyond the {} bits of object \"{}\"", 8 * object.size, object.name);
      if (!by_bit) reading.needs_number(object, value, node.pointer("value"));
    });
  }
  const std::string active = by_bit ? fmt::format("bit {}", bit) : fmt::format("value {}", value);
  if (!known.insert(fmt::format("{} {}", word, active)).second)
    reading.fault(node.pointer(), "{} of word {} has a row already", active, word);
  model::AlarmRow out{static_cast<std::uint8_t>(word),
                      static_cast<std::uint8_t>(bit),
                      by_bit ? std::nullopt : std::optional(static_cast<std::uint32_t>(value)),
                      static_cast<std::uint16_t>(node.whole("code", 0)),
                      node.text("text"),
                      (node.has("remedy") ? node : reading.document["alarms"]).text("remedy")};
  if (out.remedy.empty())
    reading.fault(node.pointer(), "says no \"remedy\", and neither does \"alarms\" for all its rows");
  reading.profile.alarms.push_back(std::move(out));
}

/// "codes": the first fault word is a CiA 402 error code itself.
void read_codes(Reading& reading, const JsonNode& codes, std::set<std::string>& known) {
  for (const JsonNode& told : codes.members()) {
    nlohmann::json row{{"value", told.key()}, {"code", told.key()}};
    const std::vector<JsonNode> texts = told.elements();
    if (texts.size() == 2) row["remedy"] = texts[1].text();
    row["text"] = texts.size() == 2 ? texts[0].text() : told.text();
    read_alarm(reading, JsonNode(row, told.pointer()), known);
  }
}

}  // namespace

void check_setup(Reading& reading) {
  for (const JsonNode& node : reading.document["setup"].elements()) {
    // Then the amount may wait for the drive, which is read before anything is written.
    const JsonNode factory = node["instead_of"];
    reading.write(node, false, !factory);
    if (factory && reading.profile.axes.size() > 1 && node["value"].has(reading.profile.axes.front()))
      reading.fault(factory.pointer(), "needs one value for all axes");
    reading.each_meaning(node.text("write"), [&](const Object& object) {
      if (object.trigger)
        reading.fault(node.pointer(), "object \"{}\" is a trigger: setup must never start anything", object.name);
      if (factory) reading.needs_readable(object, factory.pointer(), ", so nobody knows what it holds");
      for (const std::int64_t raw : node.wholes("instead_of")) reading.needs_number(object, raw, factory.pointer());
    });
  }
}

void check_checks(Reading& reading) {
  std::set<std::string> names;
  for (const JsonNode& node : reading.document["checks"].elements()) {
    const std::string name = node.text("name");
    if (!name.empty() && !names.insert(name).second)
      reading.fault(node.pointer("name"), "check \"{}\" is given twice", name);
    reading.condition(node);
    for (const JsonNode& remedy : node["remedy"].elements()) reading.write(remedy, false, false);
  }
}

void read_alarms(Reading& reading) {
  const JsonNode section = reading.document["alarms"];
  if (!section.is_object()) return;
  const std::vector<std::string> words = section.names("words");
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string at = section["words"][i].pointer();
    if (words[i] == kEmergencyWord) {
      if (!reading.profile.protocols.contains("canopen"))
        reading.fault(at, "an EMCY is canopen's alone: name an object");
      continue;
    }
    reading.each_named(words[i], at, [&](const Object& object) {
      reading.needs_readable(object, at);
      reading.needs_whole(object, at);
    });
  }
  std::set<std::string> known;
  for (const JsonNode& row : section["rows"].elements()) read_alarm(reading, row, known);
  read_codes(reading, section["codes"], known);
  if (!section.has("rows") && !section.has("codes") && !reading.profile.has_emergency_word("canopen"))
    reading.fault("/alarms", "lists no fault: give \"rows\" or \"codes\"");
}

}  // namespace axisgate::profile
