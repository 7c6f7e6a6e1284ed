// SPDX-License-Identifier: Apache-2.0
// `axisgate move lift`: which axis of which gateway that is, and what is refused, since a wrong guess turns a motor.
#include "gateway/commands/client/named_axis.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "gateway/commands/common/axis_place.hpp"
#include "tests/unit/commands/running_server.hpp"

namespace axisgate::commands {
namespace {

using test_server::RunningServer;
using testing::HasSubstr;

const AxisNames kTold{{1, "lift"}, {2, "table"}, {5, "axis 5"}};

AxisNumber number_of(const std::variant<AxisNumber, std::string>& meant) {
  const auto* number = std::get_if<AxisNumber>(&meant);
  return number == nullptr ? AxisNumber{0} : *number;
}
std::string refusal_of(const std::variant<AxisNumber, std::string>& meant) {
  const auto* why = std::get_if<std::string>(&meant);
  return why == nullptr ? "" : *why;
}

TEST(AxisMeant, IsByItsWholeNameOrItsNumber) {
  EXPECT_EQ(number_of(axis_meant("table", kTold, nullptr)), 2);
  EXPECT_EQ(number_of(axis_meant("2", kTold, nullptr)), 2);
  EXPECT_EQ(number_of(axis_meant("axis 5", kTold, nullptr)), 5) << "of one without a name of its own";
  EXPECT_EQ(
      refusal_of(axis_meant("lft", kTold, nullptr)),
      "no axis of this gateway is called 'lft'; did you mean \"lift\"? it has 1 \"lift\", 2 \"table\", 5 \"axis 5\"");
  for (const char* typed : {"lif", "Lift", "lift ", "table2", "3", "axis 1"})
    EXPECT_THAT(refusal_of(axis_meant(typed, kTold, nullptr)), HasSubstr("no axis of this gateway is called")) << typed;
}

TEST(AxisMeant, IsRefusedWhereItCouldBeTwo) {
  EXPECT_EQ(refusal_of(axis_meant("2", {{1, "2"}, {2, "table"}}, nullptr)),
            "'2' could be axis 1, which is called so, or axis 2: write HOST:PORT and the number of the axis");
  EXPECT_THAT(refusal_of(axis_meant("7", {{1, "7"}}, nullptr)), HasSubstr("'7' could be axis 1"))
      << "also where there is no 7";
  EXPECT_THAT(refusal_of(axis_meant("axis 2", {{1, "axis 2"}}, nullptr)),
              HasSubstr("could be axis 1, which is called so, or axis 2"));
  EXPECT_EQ(number_of(axis_meant("2", {{2, "2"}}, nullptr)), 2) << "both say the same";
  EXPECT_THAT(refusal_of(axis_meant("lift", {{1, "lift"}, {4, "lift"}}, nullptr)),
              HasSubstr("axes 1 and 4 are both called 'lift'"));
  EXPECT_THAT(refusal_of(axis_meant("1", {}, nullptr)), HasSubstr("does not tell what its axes are called"));
}

TEST(AxisMeant, IsRefusedWhereTheConfigurationCallsThatAxisOtherwise) {
  const ConfiguredNames same{"g.json", kTold}, swapped{"g.json", {{1, "table"}, {2, "lift"}}},
      without{"g.json", {{2, "table"}}};
  EXPECT_EQ(number_of(axis_meant("lift", kTold, &same)), 1);
  EXPECT_THAT(refusal_of(axis_meant("lift", kTold, &swapped)),
              HasSubstr("axis 1 of the running gateway is \"lift\", and in g.json \"table\": which is meant?"));
  EXPECT_THAT(refusal_of(axis_meant("1", kTold, &swapped)), HasSubstr("which is meant?")) << "a number, too";
  EXPECT_THAT(refusal_of(axis_meant("lift", kTold, &without)), HasSubstr("in g.json no axis of this number"));
  EXPECT_EQ(number_of(axis_meant("table", kTold, &without)), 2) << "others may be new";
}

TEST(AxisMeant, TakesLinesOfNamesAsTheGatewayTellsThem) {
  AxisNames names;
  add_names(names, "1 lift\n12 a b\nx\n0 none\n500 none\n");
  add_names(names, "499 last");
  EXPECT_EQ(names, (AxisNames{{1, "lift"}, {12, "a b"}, {499, "last"}}));
  EXPECT_EQ(axis_mistake("lift"), "");
  EXPECT_EQ(axis_mistake("499"), "");
  for (const char* typed : {"", "0", "500", "-1", "-", "4294967296"}) EXPECT_NE(axis_mistake(typed), "") << typed;
}

TEST(OwnGateway, IsWhereItsConfigurationLetsThisComputerIn) {
  const auto place = [](const std::string& listeners) {
    const auto own = own_gateway_in(R"({"modbus_tcp": )" + listeners + "}");
    return own ? own->place.host + " " + std::to_string(own->place.port) : "none";
  };
  EXPECT_EQ(place(R"([{"listen": "0.0.0.0:1502"}])"), "127.0.0.1 1502");
  EXPECT_EQ(place(R"([{"listen": "[::]:502"}])"), "::1 502");
  EXPECT_EQ(place(R"([{"listen": "192.168.1.5:1502"}, {"listen": "127.0.0.1:1503"}])"), "127.0.0.1 1503")
      << "its own before the others";
  EXPECT_EQ(place(R"([{"listen": "192.168.1.5:1502"}, {"listen": "0.0.0.0:1503"}])"), "192.168.1.5 1502");
  EXPECT_EQ(place(R"([{"listen": 5}, {"listen": "x"}, {"listen": "127.0.0.1:9"}])"), "127.0.0.1 9");
  for (const char* none : {"[]", "5", "[{}]", R"({"listen": "127.0.0.1:9"})"}) EXPECT_EQ(place(none), "none") << none;
  EXPECT_FALSE(own_gateway_in("no JSON"));
  const auto own = own_gateway_in(
      R"({"modbus_tcp": [{"listen": "127.0.0.1:9"}], "wrong": 1, "buses": [{"drives": [{"axes": [{"axis": 3, "name": "lift"}, {"axis": 4},
    {"axis": -1, "name": "x"}, {"axis": 500}, 7]}, 8], "adapter": 9}, 10]})");
  ASSERT_TRUE(own) << "a stop does not wait until all of a file is right";
  EXPECT_EQ(own->names, (AxisNames{{3, "lift"}, {4, "axis 4"}}));
}

struct Found {
  std::optional<FoundAxis> axis;
  std::string err;
};

Found found(const TypedAxis& typed, const std::string& usual = "/nowhere") {
  testing::internal::CaptureStderr();
  Found out;
  out.axis = find_typed_axis("stop", typed, usual);
  out.err = testing::internal::GetCapturedStderr();
  return out;
}

std::string file_with(const std::string& text) {
  const std::string file = testing::TempDir() + "named_axis.json";
  std::ofstream(file) << text;
  return file;
}

TEST(AxisOfAConfiguration, IsMeantByItsNumberOrItsNameAndNotWhereThatCouldBeTwo) {
  config::LoadedConfig loaded;
  model::DriveModel drive;
  for (const auto& [number, name] : AxisNames{{1, "lift"}, {2, "3"}, {3, "table"}}) {
    drive.axes.emplace_back();
    drive.axes.back().number = number;
    drive.axes.back().name = name;
  }
  loaded.models = {{}, {drive}};
  const auto slot_of = [&](const std::string& called) {
    const auto place = find_axis(loaded, "g.json", called);
    return place ? static_cast<int>(place->slot) : -1;
  };
  testing::internal::CaptureStderr();
  EXPECT_EQ(slot_of("1"), 0);
  EXPECT_EQ(slot_of("lift"), 0);
  EXPECT_EQ(slot_of("table"), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  EXPECT_EQ(slot_of("3"), -1);
  EXPECT_EQ(slot_of("lif"), -1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "g.json: more than one axis 3 in it: there are 1 \"lift\", 2 \"3\", 3 \"table\"\n"
            "g.json: no axis lif in it: there are 1 \"lift\", 2 \"3\", 3 \"table\"\n");
}

TEST(TypedAxis, ANumberBehindAnEndpointAsksNobody) {
  const Found it = found({"127.0.0.1:1", "1"});
  ASSERT_TRUE(it.axis) << it.err;
  EXPECT_EQ(it.axis->number, 1);
  EXPECT_EQ(it.axis->said, "");
}

TEST(TypedAxis, ANameIsThatOfTheRunningGatewayWhichIsSaid) {
  const RunningServer server({}, 3, {{2, "lift"}});
  const Found there = found({server.endpoint(), "lift"});
  ASSERT_TRUE(there.axis) << there.err;
  EXPECT_EQ(there.axis->number, 2);
  EXPECT_EQ(there.axis->said, "axis 2 \"lift\" at " + server.endpoint());
  const std::string right = R"({"modbus_tcp": [{"listen": ")" + server.endpoint() +
                            R"("}], "buses": [{"drives": [{"axes": [{"axis": 2, "name": "lift"}]}]}]})";
  const Found by_file = found({"", "lift", file_with(right)});
  ASSERT_TRUE(by_file.axis) << by_file.err;
  EXPECT_EQ(by_file.axis->place.port, server.port());
  EXPECT_TRUE(found({"", "lift"}, file_with(right)).axis) << "the configuration of the service";
  std::string edited = right;
  edited.replace(edited.find("lift"), 4, "tool");
  EXPECT_THAT(found({"", "lift", file_with(edited)}).err,
              HasSubstr("axisgate stop: " + server.endpoint() + ": axis 2 of the running gateway is \"lift\""));
  EXPECT_THAT(found({server.endpoint(), "tool"}).err, HasSubstr("no axis of this gateway is called 'tool'"));
}

TEST(TypedAxis, ManyNamesAreReadToTheirEnd) {
  std::map<AxisNumber, std::string> names;
  for (AxisNumber axis = 1; axis <= 60; ++axis) names[axis] = "a name of some length " + std::to_string(axis);
  const RunningServer server({}, 60, names);
  const Found it = found({server.endpoint(), "a name of some length 60"});
  ASSERT_TRUE(it.axis) << it.err;
  EXPECT_EQ(it.axis->number, 60);
}

TEST(TypedAxis, WithoutAGatewayItSaysWhereItLookedAndWhatToWrite) {
  EXPECT_THAT(found({"", "lift", file_with("{}")}).err,
              HasSubstr("does not say where the gateway listens: write HOST:PORT\n"));
  EXPECT_THAT(found({"", "lift"}, file_with("{}")).err, HasSubstr("write HOST:PORT, or --config CONFIG\n"));
  EXPECT_THAT(found({"", "lift", "/nowhere"}).err,
              HasSubstr("/nowhere does not say where the gateway listens (No such file or directory)"));
  EXPECT_THAT(found({"", "lift", file_with(R"({"modbus_tcp": [{"listen": "127.0.0.1:1"}]})")}).err,
              HasSubstr("cannot be asked: Connection refused"));
  testing::internal::CaptureStderr();
  const auto own = own_place("stop", "", "/nowhere");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(own);
  EXPECT_EQ(own->place.host + " " + std::to_string(own->place.port), "127.0.0.1 1502");
}

}  // namespace
}  // namespace axisgate::commands
