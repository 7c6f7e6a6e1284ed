// SPDX-License-Identifier: Apache-2.0
// How a CANopen node is mapped and started, against a small object dictionary that refuses what it is told to refuse.
#include "gateway/drive/device/node_setup.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "gateway/drive/device/bring_up.hpp"

namespace axisgate::drive {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint8_t kNode = 3;
constexpr model::ObjectId kStatusword = 0, kPosition = 1, kTorque = 2;

model::DriveModel model_with(std::vector<model::TpdoProperties> tpdos, std::vector<std::uint8_t> unused = {}) {
  model::DriveModel model;
  model.protocol = "canopen";
  model.node = kNode;
  const auto add = [&](const char* name, std::uint16_t index, std::uint8_t size) {
    model::ObjectDef object;
    object.name = name;
    object.address = {index, 0};
    object.size = size;
    model.objects.push_back(object);
  };
  add("statusword", 0x6041, 2);
  add("position_actual", 0x6064, 4);
  add("torque_actual", 0x6077, 2);
  model.canopen.tpdos = std::move(tpdos);
  model.canopen.unused_tpdos = std::move(unused);
  return model;
}

model::TpdoProperties tpdo(std::uint8_t number, std::vector<model::ObjectId> map) {
  model::TpdoProperties facts;
  facts.number = number;
  facts.map = std::move(map);
  facts.inhibit = 50;
  facts.event_ms = 100;
  return facts;
}

/// A node's communication objects, with the rules of CiA 301 that a mapping must keep.
struct Dictionary {
  std::map<ObjectAddress, std::uint32_t> values{
      {{0x1800, 1}, 0xC0000183}, {{0x1A00, 0}, 2}, {{0x1801, 1}, 0x80000283}, {{0x1A01, 0}, 0}, {{0x1802, 1}, 0x383}};
  std::map<std::pair<ObjectAddress, std::uint32_t>, std::uint32_t> refused_values{};  ///< value -> abort code
  std::map<ObjectAddress, std::uint32_t> refused_writes{};
  std::set<ObjectAddress> forgets{};  ///< acknowledges a write and keeps what it had
  std::vector<std::uint32_t> commands{};
  std::vector<std::string> broken_rules{};

  bus::ExchangeResult answer(const bus::Exchange& exchange) {
    if (exchange.access == bus::Access::command) {
      commands.push_back(exchange.raw);
      return {};
    }
    if (exchange.access == bus::Access::write) return write(exchange);
    const auto at = values.find(exchange.object);
    if (at == values.end()) return {.code = Errc::refused_by_drive, .detail = 0x06020000};
    bus::ExchangeResult result;
    result.fields.push_back({exchange.object, exchange.size, at->second});
    return result;
  }

  bus::ExchangeResult write(const bus::Exchange& e) {
    if (commands.empty() || commands.back() != 0x80) broken_rules.emplace_back("written outside pre-operational");
    const bool mapping = e.object.index >= 0x1A00;
    const std::uint32_t cob_id = values[{static_cast<std::uint16_t>(e.object.index - (mapping ? 0x200 : 0)), 1}];
    if (mapping && (cob_id & 0x80000000) == 0) broken_rules.emplace_back("mapped while the TPDO was on");
    if (mapping && e.object.sub != 0 && values[{e.object.index, 0}] != 0)
      broken_rules.emplace_back("an entry was written while the count was not 0");
    if (const auto at = refused_writes.find(e.object); at != refused_writes.end())
      return {.code = Errc::refused_by_drive, .detail = at->second};
    if (const auto at = refused_values.find({e.object, e.raw}); at != refused_values.end())
      return {.code = Errc::refused_by_drive, .detail = at->second};
    if (!forgets.contains(e.object)) values[e.object] = e.raw;
    return {};
  }
};

NodeSetup carried_out(const model::DriveModel& model, Dictionary& dictionary) {
  NodeSetup setup(model);
  setup.begin();
  constexpr int kLongest = 200;
  for (int i = 0; i < kLongest; ++i) {
    const auto exchange = setup.next();
    if (!exchange) return setup;
    EXPECT_EQ(exchange->node, kNode);
    setup.on_result(dictionary.answer(*exchange));
  }
  ADD_FAILURE() << "it never ends";
  return setup;
}

TEST(NodeSetup, MapsInPreOperationalAndStartsTheNodeAtTheEnd) {
  const model::DriveModel model = model_with({tpdo(1, {kStatusword, kPosition})});
  Dictionary drive;
  const NodeSetup setup = carried_out(model, drive);
  EXPECT_THAT(drive.broken_rules, IsEmpty());
  EXPECT_THAT(drive.commands, ElementsAre(0x80, 0x01));
  EXPECT_EQ((drive.values[{0x1A00, 0}]), 2U);
  EXPECT_EQ((drive.values[{0x1A00, 1}]), 0x60410010U);
  EXPECT_EQ((drive.values[{0x1A00, 2}]), 0x60640020U);
  EXPECT_EQ((drive.values[{0x1800, 1}]), 0x40000183U) << "on, and no remote frames, as the drive had it";
  EXPECT_EQ((drive.values[{0x1800, 2}]), 255U);
  EXPECT_EQ((drive.values[{0x1800, 3}]), 50U);
  EXPECT_EQ((drive.values[{0x1800, 5}]), 100U);
  EXPECT_THAT(setup.mapped(), ElementsAre(MappedTpdo{1, {kStatusword, kPosition}, std::uint16_t{100}}));
  EXPECT_THAT(setup.notes(), IsEmpty());
}

TEST(NodeSetup, AnObjectThatCannotBeMappedCostsThatObjectAlone) {
  const model::DriveModel model = model_with({tpdo(1, {kStatusword, kTorque, kPosition})});
  Dictionary drive;
  drive.refused_values[{{0x1A00, 2}, 0x60770010}] = 0x06040041;
  const NodeSetup setup = carried_out(model, drive);
  EXPECT_THAT(drive.broken_rules, IsEmpty());
  EXPECT_THAT(setup.mapped(), ElementsAre(MappedTpdo{1, {kStatusword, kPosition}, std::uint16_t{100}}));
  EXPECT_EQ((drive.values[{0x1A00, 2}]), 0x60640020U) << "the next one takes its place";
  EXPECT_THAT(setup.notes(), ElementsAre(testing::AllOf(HasSubstr("torque_actual"), HasSubstr("0x06040041"))));
}

TEST(NodeSetup, ADriveWithoutAnEventTimerIsMappedAllTheSame) {
  const model::DriveModel model = model_with({tpdo(1, {kStatusword})});
  Dictionary drive;
  drive.refused_writes[{0x1800, 5}] = 0x06090011;
  const NodeSetup setup = carried_out(model, drive);
  EXPECT_THAT(setup.mapped(), ElementsAre(MappedTpdo{1, {kStatusword}, std::nullopt}));
  EXPECT_THAT(setup.notes(), ElementsAre(HasSubstr("no event timer")));
}

TEST(NodeSetup, AnyOtherRefusalLeavesThatTpdoOffAndGoesOnWithTheNext) {
  const std::vector<ObjectAddress> steps{{0x1800, 1}, {0x1A00, 0}, {0x1800, 2}};
  for (const ObjectAddress step : steps) {
    SCOPED_TRACE(testing::PrintToString(step.index) + ":" + testing::PrintToString(int{step.sub}));
    const model::DriveModel model = model_with({tpdo(1, {kStatusword}), tpdo(2, {kPosition})});
    Dictionary drive;
    drive.refused_writes[step] = 0x08000022;
    const NodeSetup setup = carried_out(model, drive);
    EXPECT_THAT(setup.mapped(), ElementsAre(MappedTpdo{2, {kPosition}, std::uint16_t{100}}));
    EXPECT_THAT(setup.notes(), ElementsAre(HasSubstr("TPDO 1")));
    EXPECT_THAT(drive.commands, ElementsAre(0x80, 0x01));
  }
}

TEST(NodeSetup, ATpdoThatTheDriveDoesNotHaveIsPolled) {
  const model::DriveModel model = model_with({tpdo(4, {kStatusword})});
  Dictionary drive;
  const NodeSetup setup = carried_out(model, drive);
  EXPECT_THAT(setup.mapped(), IsEmpty());
  EXPECT_THAT(setup.notes(), ElementsAre(HasSubstr("is not there")));
}

TEST(NodeSetup, ATpdoWhoseMappingDoesNotReadBackIsNotTrusted) {
  for (const ObjectAddress forgotten : {ObjectAddress{0x1A00, 0}, ObjectAddress{0x1A00, 2}, ObjectAddress{0x1800, 1}}) {
    const model::DriveModel model = model_with({tpdo(1, {kStatusword, kPosition})});
    Dictionary drive;
    drive.values[{0x1800, 1}] = 0x80000183;
    drive.values[{0x1A00, 0}] = 0;
    drive.values[{0x1A00, 2}] = 0x60640010;  // position_actual, but 2 bytes of it
    drive.forgets.insert(forgotten);
    const NodeSetup setup = carried_out(model, drive);
    EXPECT_THAT(setup.mapped(), IsEmpty());
    EXPECT_THAT(setup.notes(), ElementsAre(HasSubstr("does not read back")));
  }
}

TEST(NodeSetup, AnUnusedTpdoThatIsOnIsSwitchedOffAndOneThatIsNotThereIsLeftAlone) {
  const model::DriveModel model = model_with({}, {2, 3, 4});
  Dictionary drive;
  const NodeSetup setup = carried_out(model, drive);
  EXPECT_EQ((drive.values[{0x1802, 1}]), 0x80000383U);
  EXPECT_EQ((drive.values[{0x1801, 1}]), 0x80000283U);
  EXPECT_FALSE(drive.values.contains({0x1803, 1}));
  EXPECT_THAT(setup.notes(), IsEmpty());
}

TEST(NodeSetup, WhatWasLostIsAskedOnceMoreAndNothingIsSkipped) {
  const model::DriveModel model = model_with({tpdo(1, {kStatusword, kPosition})});
  Dictionary drive;
  NodeSetup setup(model);
  setup.begin();
  for (auto exchange = setup.next(); exchange; exchange = setup.next()) {
    EXPECT_EQ(setup.next(), exchange) << "the same until its result is there";
    setup.on_result(drive.answer(*exchange));
  }
  EXPECT_EQ(setup.mapped().size(), 1U);
}

TEST(IdentityCheck, OnlyTheConfiguredNumbersAreReadAndEachDifferenceIsTold) {
  model::DriveModel model = model_with({});
  model.canopen.identity = {0x4321, std::nullopt, 7, 99};
  IdentityCheck check(model);
  check.begin();
  std::vector<int> subs;
  const std::map<int, bus::ExchangeResult> answers{{1, {.fields = {{{0x1018, 1}, 4, 0x4321}}}},
                                                   {3, {.fields = {{{0x1018, 3}, 4, 8}}}},
                                                   {4, {.code = Errc::refused_by_drive, .detail = 0x06090011}}};
  for (auto exchange = check.next(); exchange; exchange = check.next()) {
    EXPECT_EQ(exchange->object.index, 0x1018);
    subs.push_back(exchange->object.sub);
    check.on_result(answers.at(exchange->object.sub));
  }
  EXPECT_THAT(subs, ElementsAre(1, 3, 4));
  EXPECT_THAT(check.mismatch(), HasSubstr("revision is 0x8, configured 0x7"));
  EXPECT_THAT(check.mismatch(), HasSubstr("serial is not told"));
  EXPECT_THAT(check.mismatch(), testing::Not(HasSubstr("vendor")));
}

TEST(IdentityCheck, WithoutAConfiguredIdentityNothingIsRead) {
  const model::DriveModel model = model_with({});
  IdentityCheck check(model);
  check.begin();
  EXPECT_FALSE(check.next());
  EXPECT_THAT(check.mismatch(), IsEmpty());
}

}  // namespace
}  // namespace axisgate::drive
