// SPDX-License-Identifier: Apache-2.0
// The shipped Kinco profiles against the manuals' object tables: no address, width, sign or access may be mistyped.
#include <map>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// The manual's row of each index and sub-index.
std::map<ObjectAddress, json> rows_of(const std::string& drive) {
  std::map<ObjectAddress, json> out;
  const json objects = manual(drive)["objects"];
  for (const json& row : objects) {
    if (row["sub"].is_null()) continue;
    const std::int64_t sub = row["sub"].is_string() ? hex(row["sub"]) : row["sub"].get<std::int64_t>();
    out[{static_cast<std::uint16_t>(hex(row["index"])), static_cast<std::uint8_t>(sub)}] = row;
  }
  return out;
}

void check_register(const Object& object, const json& row) {
  const auto place = object.places.find("modbus-rtu");
  const bool known =
      row.contains("modbus") && row["modbus"].is_string() && row["modbus"].get<std::string>().starts_with("0x");
  if (place == object.places.end()) {
    EXPECT_FALSE(known && row["modbus_origin"] == "printed") << "the manual prints a register: " << row["modbus"];
    return;
  }
  ASSERT_TRUE(known) << "no register in the manual";
  EXPECT_EQ(place->second.address.index, hex(row["modbus"]));
  EXPECT_EQ(place->second.derived, row["modbus_origin"] != "printed");
}

/// Communication objects of which the JD's manual prints the index alone: sub-index and width are CiA 301's.
bool only_named(const ObjectAddress& address) {
  return address == ObjectAddress{0x1016, 1} || address == ObjectAddress{0x1017, 0};
}

void check_profile(const std::string& drive, std::size_t at_least) {
  const LoadedProfile loaded = load_profile(shipped(drive));
  const auto rows = rows_of(drive);
  EXPECT_GE(loaded.profile.objects.size(), at_least);
  for (const Object& object : loaded.profile.objects) {
    const auto serial = object.places.find("kinco-serial");
    const auto can = object.places.find("canopen");
    ASSERT_NE(can, object.places.end()) << object.name;
    const auto row = rows.find(can->second.address);
    if (row == rows.end() && drive == "kinco-jd" && only_named(can->second.address)) continue;
    ASSERT_NE(row, rows.end()) << object.name << " is at an address that the manual does not have";
    SCOPED_TRACE(object.name);
    check_row(object, row->second);
    if (serial == object.places.end()) continue;  // a CANopen communication object
    EXPECT_EQ(serial->second.address, can->second.address) << object.name;
    check_register(object, row->second);
  }
}

TEST(KincoJd, EveryObjectIsWhereAndAsTheManualSays) { check_profile("kinco-jd", 40); }
TEST(KincoMd, EveryObjectIsWhereAndAsTheManualSays) { check_profile("kinco-md", 35); }

TEST(KincoJd, EachBitOfTheFirstFaultWordHasItsCode) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  EXPECT_EQ(model.alarms.size(), 16U);
  for (const model::AlarmRow& row : model.alarms) EXPECT_NE(row.code, 0) << row.text;
  EXPECT_EQ(model.alarms.back().bit, 0) << "the vaguest fault speaks last";
}

TEST(Kinco, WhatItsMakerDoesBesideCia402IsInItsProfile) {
  for (const char* drive : {"kinco-jd", "kinco-md"}) {
    const model::AxisModel axis = resolved(shipped(drive), kinco_axis()).axes[0];
    EXPECT_EQ(axis.cia402.velocity_modes, std::vector<std::int16_t>{-3}) << drive;
    EXPECT_EQ(axis.cia402.follow_bits, 0xF800) << drive;
    EXPECT_EQ(axis.velocity_lag, std::chrono::milliseconds(300)) << drive;
  }
}

TEST(KincoMd, TheSecondFaultWordSpeaksBeforeTheBitThatPointsToIt) {
  const model::DriveModel model = resolved(shipped("kinco-md"), kinco_axis());
  EXPECT_EQ(model.alarms.size(), 27U);
  EXPECT_EQ(model.alarms.back().word, 0);
  EXPECT_EQ(model.alarms.back().bit, 0);
}

}  // namespace
}  // namespace axisgate::profile
