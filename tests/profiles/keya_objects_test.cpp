// SPDX-License-Identifier: Apache-2.0
// The shipped Keya profile against the manual's tables: where each object is, how it is read, what each fault means.
#include <gmock/gmock.h>

#include <set>

#include "tests/profiles/keya.hpp"
#include "tests/profiles/mistakes.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::IsEmpty;

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 3)
    out.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  return out;
}

/// What an adapter makes of an answer: the number of this object, from the data of the frame.
std::int64_t number_in(const model::ObjectDef& object, const std::vector<std::uint8_t>& data) {
  std::uint32_t raw = 0;
  for (std::size_t i = 0; i < object.size; ++i) raw = raw << 8 | data.at(object.address.byte + i);
  return object.number(raw);
}

/// How the manual's own examples call what the profile calls otherwise.
const std::map<std::string, std::string>& called() {
  static const std::map<std::string, std::string> kNames{{"fault_m1", "A.fault"},
                                                         {"fault_m2", "B.fault"},
                                                         {"fault_a", "A.fault"},
                                                         {"fault_b", "B.fault"},
                                                         {"speed_a_rpm", "A.speed"},
                                                         {"speed_b_rpm", "B.speed"},
                                                         {"current_a_A", "A.current"},
                                                         {"current_b_A", "B.current"},
                                                         {"encoder_a", "A.position"},
                                                         {"encoder_b", "B.position"},
                                                         {"voltage_V", "voltage"},
                                                         {"drive_temp_C", "drive_temperature"},
                                                         {"version", "program_version"},
                                                         {"motor_a_temp_C", "A.motor_temperature"},
                                                         {"motor_b_temp_C", "B.motor_temperature"}};
  return kNames;
}

/// Index, sub and data of an answer, or nothing where the frame is no answer to a query.
struct Answer {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::vector<std::uint8_t> data;
};

std::optional<Answer> answer_in(const json& vector) {
  if (vector.at("direction") != "response") return std::nullopt;
  const std::string protocol = vector.at("protocol");
  const std::vector<std::uint8_t> frame = bytes_of(vector.value("hex_corrected", vector.at("hex").get<std::string>()));
  const auto data = [&](std::size_t from, std::size_t end) {
    return std::vector<std::uint8_t>(frame.begin() + static_cast<std::ptrdiff_t>(from),
                                     frame.begin() + static_cast<std::ptrdiff_t>(end));
  };
  if (protocol == "keya-can" && frame.size() == 8 && frame[0] == 0x60 && frame[2] == 0x21)
    return Answer{static_cast<std::uint16_t>(frame[2] << 8 | frame[1]), frame[3], data(4, 8)};
  if (protocol == "keya-rs232" && frame.at(0) == 0xED)
    return Answer{static_cast<std::uint16_t>(0x2100 + frame[1]), 0, data(2, 12)};
  if (protocol == "keya-rs485" && frame.at(0) == 0xED)
    return Answer{static_cast<std::uint16_t>(0x2100 + frame[2]), 0, data(3, 11)};
  return std::nullopt;
}

TEST(Keya, EveryAnswerTheManualPrintsIsReadAsItSays) {
  std::map<std::string, int> checked;
  for (const json& vector : keya::vectors("vectors")) {
    const std::optional<Answer> answer = answer_in(vector);
    if (!answer) continue;
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const model::DriveModel model = keya::model(keya::drive(vector.at("protocol")));
    for (const auto& [name, value] : vector.at("decoded").items()) {
      const auto known = called().find(name);
      if (known == called().end() || !value.is_number_integer()) continue;
      const model::ObjectDef& object = keya::object(model, known->second);
      EXPECT_EQ(object.address.index, answer->index) << name;
      EXPECT_EQ(object.address.sub, answer->sub) << name;
      EXPECT_EQ(number_in(object, answer->data), value.get<std::int64_t>()) << name;
      ++checked[vector.at("protocol")];
    }
  }
  EXPECT_GE(checked["keya-can"], 2);
  EXPECT_GE(checked["keya-rs232"], 11);
  EXPECT_GE(checked["keya-rs485"], 13);
}

std::set<ObjectAddress> places(const model::DriveModel& model) {
  std::set<ObjectAddress> out;
  for (const model::ObjectDef& object : model.objects)
    if (!object.emulated) out.insert(object.address);
  return out;
}

TEST(Keya, EveryCommandAndQueryOfItsOwnCanProtocolIsThere) {
  const model::DriveModel model = keya::model(keya::drive("keya-can"));
  int commands = 0, queries = 0;
  for (const json& row : keya::vectors("objects")) {
    const std::string group = row.at("group");
    if (group != "keya-can command" && group != "keya-can query") continue;
    SCOPED_TRACE(row.at("name").get<std::string>());
    const auto index = static_cast<std::uint16_t>(std::stoul(row.at("index").get<std::string>(), nullptr, 16));
    const auto sub = row.at("sub").get<std::uint8_t>();
    int found = 0;
    for (const model::ObjectDef& object : model.objects) {
      if (object.emulated || object.address.index != index || object.address.sub != sub) continue;
      ++found;
      const bool command = group == "keya-can command";
      EXPECT_EQ(object.writable, command);
      EXPECT_EQ(object.readable, !command) << "a command cannot be read back";
      if (!command) continue;
      EXPECT_EQ(object.size, 4);
      EXPECT_TRUE(object.trigger);
      EXPECT_EQ(object.slot, sub - 1);
    }
    // A query that answers for both motors holds several.
    EXPECT_GE(found, row.at("type").get<std::string>().find('x') == std::string::npos ? 1 : 2);
    ++(group == "keya-can command" ? commands : queries);
  }
  EXPECT_EQ(commands, 10);
  EXPECT_EQ(queries, 7);
  EXPECT_EQ(keya::object(model, "voltage").address, (ObjectAddress{0x210D, 2, 3})) << "the last of four bytes";
  EXPECT_EQ(keya::object(model, "A.motor_temperature").address, (ObjectAddress{0x210F, 1, 2}));
  EXPECT_EQ(keya::object(model, "B.motor_temperature").address, (ObjectAddress{0x210F, 1, 3}));
}

TEST(Keya, EveryQueryWhoseAnswerIsDocumentedIsAskedOnTheSerialProtocols) {
  for (const std::string protocol : {"keya-rs232", "keya-rs485"}) {
    const auto there = places(keya::model(keya::drive(protocol)));
    int checked = 0;
    for (const json& row : keya::vectors("objects")) {
      if (row.at("group") != "keya-rs232/rs485 query") continue;
      const std::string address = row.at("address");
      const auto index =
          static_cast<std::uint16_t>(0x2100 + std::stoul(address.substr(address.size() - 2), nullptr, 16));
      const bool documented = row.value("note", "").find("not documented") == std::string::npos;
      EXPECT_EQ(std::any_of(there.begin(), there.end(), [&](const auto& at) { return at.index == index; }), documented)
          << protocol << " " << row;
      ++checked;
    }
    EXPECT_EQ(checked, 10);
  }
}

TEST(Keya, TheControlFrameIsListedInItsOrderAndWrittenOnly) {
  for (const std::string protocol : {"keya-rs232", "keya-rs485"}) {
    const model::DriveModel model = keya::model(keya::drive(protocol));
    const std::vector<ObjectAddress> order{{0x200D, 1, 0}, {0x200D, 2, 0}, {0x2000, 1, 0}, {0x2000, 2, 0}};
    ASSERT_EQ(model.composed.size(), order.size()) << protocol;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const model::ObjectDef& object = model.object(model.composed[i]);
      EXPECT_EQ(object.address, order[i]) << object.name;
      EXPECT_EQ(object.size, i < 2 ? 1 : 4);
      EXPECT_EQ(object.is_signed, i >= 2);
      EXPECT_EQ(object.turns_on, i < 2);
      EXPECT_EQ(object.slot, i % 2);
    }
    for (const model::ObjectDef& object : model.objects) {
      EXPECT_EQ(object.composed, !object.emulated && object.writable) << object.name;
      if (object.composed) {
        EXPECT_FALSE(object.readable) << object.name;
      }
    }
  }
  for (const std::string protocol : {"canopen", "keya-can"})
    EXPECT_THAT(keya::model(keya::drive(protocol)).composed, IsEmpty());
}

TEST(Keya, NamesOfOnePlaceKnowEachOther) {
  const auto aliases = [](const model::DriveModel& model, const std::string& name) {
    return names(model, keya::object(model, name).aliases);
  };
  for (const std::string protocol : {"canopen", "keya-rs232", "keya-rs485"}) {
    const model::DriveModel model = keya::model(keya::drive(protocol));
    EXPECT_THAT(aliases(model, "A.target_velocity"),
                testing::UnorderedElementsAre("A.target_position", "A.target_torque"));
    EXPECT_THAT(aliases(model, "B.target_position"),
                testing::UnorderedElementsAre("B.target_velocity", "B.target_torque"));
  }
  const model::DriveModel can = keya::model(keya::drive("keya-can"));
  for (const model::ObjectDef& object : can.objects) EXPECT_THAT(object.aliases, IsEmpty()) << object.name;
}

TEST(Keya, TheObjectsOfItsCanopenDictionaryAreAsPrinted) {
  const model::DriveModel model = keya::model(keya::drive("canopen"));
  std::map<std::pair<int, int>, json> printed;
  for (const json& row : keya::vectors("objects"))
    if (row.at("group") == "canopen")
      printed[{std::stoi(row.at("index").get<std::string>(), nullptr, 16), row.at("sub").get<int>()}] = row;
  for (const model::ObjectDef& object : model.objects) {
    if (object.emulated) continue;
    SCOPED_TRACE(object.name);
    const auto row = printed.find({object.address.index, object.address.sub});
    ASSERT_NE(row, printed.end());
    const std::string type = row->second.at("type");
    EXPECT_EQ(object.size * 8, std::stoi(type.substr(1)));
    EXPECT_EQ(object.is_signed, type.starts_with("i"));
    if (object.writable) {
      EXPECT_TRUE(row->second.at("access").get<std::string>().starts_with("RW"));
    }
  }
  const auto there = places(model);
  for (const auto& [index, sub] :
       {std::pair(0x607A, 0), {0x6081, 0}, {0x6083, 0}, {0x6084, 0}, {0x6099, 1}, {0x6099, 2}})
    EXPECT_TRUE(there.contains({static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub), 0})) << index;
}

TEST(Keya, MapsTheTpdosTheDriveHasByItself) {
  const model::DriveModel model = keya::model(keya::drive("canopen"));
  const model::CanopenProperties& facts = model.canopen;
  ASSERT_EQ(facts.tpdos.size(), 3U);
  std::map<std::pair<int, int>, std::string> defaults;
  for (const json& row : keya::vectors("objects"))
    if (row.at("group") == "canopen" && row.contains("default") && row["default"].is_string())
      defaults[{std::stoi(row.at("index").get<std::string>(), nullptr, 16), row.at("sub").get<int>()}] = row["default"];
  for (const model::TpdoProperties& tpdo : facts.tpdos) {
    EXPECT_EQ(tpdo.type, 255);
    EXPECT_EQ(tpdo.event_ms, 100);
    EXPECT_EQ(tpdo.inhibit, 20) << "in steps of 1 ms";
    for (std::size_t i = 0; i < tpdo.map.size(); ++i) {
      const model::ObjectDef& object = model.object(tpdo.map[i]);
      const std::uint32_t entry = std::uint32_t{object.address.index} << 16 | object.size * 8U;
      EXPECT_EQ(std::stoul((defaults[{0x1A00 + tpdo.number - 1, static_cast<int>(i) + 1}]), nullptr, 16), entry);
    }
  }
  EXPECT_EQ(facts.heartbeat, std::chrono::milliseconds(1000));
  ASSERT_EQ(model.setup.size(), 1U);
  EXPECT_EQ(model.object(model.setup[0].object).address.index, 0x1017);
  EXPECT_TRUE(model.object(model.setup[0].object).any_width) << "32 bits printed, 16 in CiA 301";
}

TEST(Keya, WhatComesUnaskedIsNeverAskedFor) {
  const model::DriveModel model = keya::model(keya::drive("keya-can"));
  EXPECT_EQ(model.unsolicited.every, std::chrono::seconds(1));
  EXPECT_THAT(names(model, model.unsolicited.objects), testing::UnorderedElementsAre("A.work_mode", "interface"));
  EXPECT_EQ(keya::object(model, "A.work_mode").address, (ObjectAddress{0x7000, 0, 7}));
  for (const model::ObjectId object : model.unsolicited.objects) EXPECT_FALSE(model.object(object).readable);
  for (const std::string protocol : {"canopen", "keya-rs232", "keya-rs485"})
    EXPECT_THAT(keya::model(keya::drive(protocol)).unsolicited.objects, IsEmpty());
}

TEST(Keya, WhatComesUnaskedAloneIsNoQuantity) {
  json profile = json::parse(test::content(shipped("keya-kydas4860-2e")));
  profile["quantities"]["digital_inputs"] = {{"object", "interface"}};
  const test::OwnFolder folder;
  const std::string file = folder.write("keya-kydas4860-2e.json", profile.dump()).string();
  EXPECT_EQ(resolved(load_profile(file), keya::drive("keya-can")).axes[0].binding(Quantity::digital_inputs), nullptr);
}

TEST(Keya, ItsFaultsHaveTheManualsRemediesAndDisabledIsNone) {
  const model::DriveModel model = keya::model(keya::drive("keya-can"));
  const model::VirtualProperties& facts = *model.axes[0].virtual_axis;
  const model::ObjectDef& word = keya::object(model, "A.fault");
  std::map<int, model::AlarmRow> rows;
  for (const model::AlarmRow& row : model.alarms) rows[row.bit] = row;
  for (const json& row : keya::vectors("alarms")) {
    const int bit = row.at("bit");
    SCOPED_TRACE(bit);
    EXPECT_EQ(rows.contains(bit), bit != 0);
    // 14 and 15 are the watchdog's: the motor is disabled, and only the next enable clears them.
    EXPECT_EQ(facts.fault.holds(word, 1U << bit), bit >= 1 && bit <= 13);
    if (bit == 0) continue;
    EXPECT_NE(rows[bit].text.find("No. " + std::to_string(row.at("number").get<int>())), std::string::npos);
    // "Look at both fault words" is for the gateway to do: it has them.
    const bool points_elsewhere = row.at("reset").get<std::string>().starts_with("look at both fault words");
    EXPECT_EQ(rows[bit].remedy == row.at("reset"), !points_elsewhere) << rows[bit].remedy;
    EXPECT_EQ(rows[bit].code == 0x8130, bit >= 14);
  }
  EXPECT_FALSE(facts.enabled.holds(word, 1));
  EXPECT_TRUE(facts.enabled.holds(word, 0x0810));
  const model::Binding& vendor = *model.axes[1].binding(Quantity::vendor_error);
  ASSERT_EQ(vendor.bits.size(), 1U);
  EXPECT_EQ(model.object(vendor.bits[0].object).name, "B.fault");
  EXPECT_EQ(vendor.bits[0].from, 1) << "bit 0 says that the motor is disabled";
  EXPECT_EQ(vendor.bits[0].to, 1);
  EXPECT_EQ(vendor.bits[0].count, 15);
}

TEST(Keya, AResynchronisationIsReadsThatNoOtherAnswers) {
  for (const std::string protocol : keya::kProtocols)
    for (const std::vector<std::string>& motors : {std::vector<std::string>{"A", "B"}, {"B"}}) {
      const model::DriveModel model = keya::model(keya::drive(protocol, motors));
      std::set<std::pair<int, int>> asked;
      for (const model::ResyncRead& read : model.resync.candidates) {
        EXPECT_TRUE(model.object(read.object).readable) << protocol;
        asked.insert({model.object(read.object).address.index, model.object(read.object).address.sub});
      }
      EXPECT_EQ(asked.size(), 3U) << protocol;
    }
}

}  // namespace
}  // namespace axisgate::profile
