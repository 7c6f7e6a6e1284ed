// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

/// id and text of each object in a reply, as "00 axisgate".
std::vector<std::string> objects_in(const std::string& reply) {
  const auto pdu = bytes(reply);
  std::vector<std::string> out;
  std::size_t at = 7;
  while (at + 2 <= pdu.size()) {
    const Byte id[] = {pdu[at]};
    const std::size_t size = pdu[at + 1];
    EXPECT_LE(at + 2 + size, pdu.size());
    out.push_back(hex_text(id) + " " +
                  std::string(pdu.begin() + static_cast<std::ptrdiff_t>(at) + 2,
                              pdu.begin() + static_cast<std::ptrdiff_t>(at + 2 + size)));
    at += 2 + size;
  }
  EXPECT_EQ(out.size(), pdu[6]);
  return out;
}

using Identification = AtTheDesk;

TEST_F(Identification, EachLevelAddsItsOwnToTheOneBefore) {
  EXPECT_EQ(plc.ask("2B 0E 01 00").substr(0, 20), "2B 0E 01 83 00 00 03");
  EXPECT_EQ(objects_in(plc.ask("2B 0E 02 00")).size(), 6U);
  const auto objects = objects_in(plc.ask("2B 0E 03 00"));
  ASSERT_EQ(objects.size(), 13U);
  EXPECT_EQ(objects[0], "00 axisgate");
  EXPECT_EQ(objects[1], "01 axisgate");
  EXPECT_GT(objects[2].size(), 5U) << "the version";
  EXPECT_EQ(objects[3].substr(0, 2), "04") << "no vendor URL";
  EXPECT_EQ(objects[6], "80 3");
  EXPECT_EQ(objects[7], "81 1");
  EXPECT_EQ(objects[8], "82 high-first");
  EXPECT_EQ(objects[9], "83 flat");
  EXPECT_EQ(objects[10], "84 integer");
  EXPECT_EQ(objects[11], "85 refused");
  EXPECT_EQ(objects[12].substr(0, 5), "90 1 ") << "what the axes are called";
  desk.settings.float_numbers = desk.settings.staged_halves = true;
  const auto of_a_panel = objects_in(plc.ask("2B 0E 03 84"));
  EXPECT_EQ(of_a_panel, (std::vector<std::string>{"84 float", "85 staged", objects[12]}));
}

TEST_F(Identification, AStreamBeginsAtTheObjectAskedForOrAtTheFirst) {
  EXPECT_EQ(objects_in(plc.ask("2B 0E 03 80")).front(), "80 3");
  EXPECT_EQ(objects_in(plc.ask("2B 0E 03 7E")).front(), "00 axisgate") << "no such object";
  EXPECT_EQ(objects_in(plc.ask("2B 0E 01 80")).front(), "00 axisgate") << "not of this level";
  EXPECT_EQ(objects_in(plc.ask("2B 0E 01 02")).size(), 1U);
}

TEST_F(Identification, EachObjectIsReadAlone) {
  EXPECT_EQ(plc.ask("2B 0E 04 80"), "2B 0E 04 83 00 00 01 80 01 33");
  EXPECT_EQ(plc.ask("2B 0E 04 03"), "AB 02");
  EXPECT_EQ(plc.ask("2B 0E 04 FF"), "AB 02");
}

// `axisgate move lift` asks for them: a name that was cut would be another axis's.
TEST(IdentificationNames, AreWholeInEachObjectAndEndWhereTheObjectsDo) {
  for (const AxisNumber axes : {AxisNumber{3}, kMaxAxisNumber}) {
    ProcessImage image;
    const std::string name(axes == 3 ? 20 : 32, 'n');
    for (AxisNumber axis = 1; axis <= axes; ++axis) image.add_axis(axis, name + std::to_string(axis), 0);
    std::string told;
    std::uint8_t next = kNamesObject;
    for (const IdentificationObject& object : identification_objects(image, {})) {
      if (object.id < kNamesObject) continue;
      EXPECT_EQ(object.id, next++);
      EXPECT_LE(object.value.size(), 245U);
      EXPECT_EQ(object.value.back(), '\n');
      told += object.value;
    }
    std::string all;
    for (AxisNumber axis = 1; axis <= axes; ++axis)
      all += std::to_string(axis) + " " + name + std::to_string(axis) + "\n";
    EXPECT_EQ(told, all);
  }
  ProcessImage too_much;
  for (AxisNumber axis = 1; axis <= kMaxAxisNumber; ++axis) too_much.add_axis(axis, std::string(128, 'n'), 0);
  const auto objects = identification_objects(too_much, {});
  EXPECT_EQ(objects.back().id, kLastNamesObject);
  EXPECT_EQ(objects.size(), 12U + (kLastNamesObject - kNamesObject + 1U));
}

TEST(IdentificationStreams, ContinueWhereOnePduIsFull) {
  std::vector<IdentificationObject> objects;
  for (int id = 0x80; id < 0x90; ++id) objects.push_back({static_cast<std::uint8_t>(id), std::string(60, 'x')});
  Request request;
  request.function = Function::encapsulated_interface;
  request.identification = 3;
  std::size_t seen = 0;
  for (int answers = 0; answers < 10; ++answers) {
    const Pdu pdu = answer_identification(request, objects);
    EXPECT_LE(pdu.size(), kMaxPdu);
    seen += objects_in(hex_text({pdu.data(), pdu.size()})).size();
    if (pdu[4] == 0) {
      EXPECT_EQ(pdu[5], 0);
      break;
    }
    EXPECT_EQ(pdu[4], 0xFF);
    request.object = pdu[5];
  }
  EXPECT_EQ(seen, objects.size());
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
