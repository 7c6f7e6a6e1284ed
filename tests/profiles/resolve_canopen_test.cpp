// SPDX-License-Identifier: Apache-2.0
// What a CANopen section of a profile comes to: mapping, heartbeats and guarding, what the drive must hold to stop by
// itself, and the identity that a configuration asks for.
#include <gmock/gmock.h>

#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Raw = std::vector<std::pair<std::string, std::int64_t>>;

Raw setup_of(const model::DriveModel& model) {
  Raw out;
  for (const model::ObjectWrite& write : model.setup) out.emplace_back(model.object(write.object).name, write.raw);
  return out;
}

model::DriveModel on_canopen(const std::string& profile) { return resolved(shipped(profile), one_axis("canopen")); }

/// A drive of one TPDO, with changes.
class CanopenProfile : public ::testing::Test {
 protected:
  LoadedProfile load() { return load_profile(folder_.write("canopen-only.json", profile_.dump()).string()); }
  model::DriveModel model() { return resolved(load(), one_axis("canopen")); }
  nlohmann::json& canopen() { return profile_["protocols"]["canopen"]; }

  const test::OwnFolder folder_;
  nlohmann::json profile_ = [] {
    const std::string file = test::source_path("tests/config/invalid/profiles/canopen-only.json");
    nlohmann::json out = nlohmann::json::parse(test::content(file));
    out["protocols"]["canopen"]["tpdo"] = {{{"n", 2}, {"map", {"statusword", "mode"}}}};
    return out;
  }();
};

TEST(KincoJdOnCanopen, TellsAndHearsHeartbeats) {
  const model::DriveModel model = on_canopen("kinco-jd");
  EXPECT_EQ(setup_of(model).front(), (Raw::value_type{"controlword", 6})) << "it ignores every word before this one";
  EXPECT_THAT(setup_of(model), Contains(Raw::value_type{"producer_heartbeat", 1000}));
  EXPECT_EQ(setup_of(model).back(), (Raw::value_type{"consumer_heartbeat", 0x007F05DC}));
  EXPECT_THAT(names(model, model.loss_objects), ElementsAre("consumer_heartbeat"));
  EXPECT_EQ(model.canopen.heartbeat, milliseconds(1000));
  EXPECT_EQ(model.canopen.own_heartbeat, milliseconds(500)) << "three within the time the drive waits";
  EXPECT_EQ(model.canopen.guard_time, Duration{});
  EXPECT_TRUE(model.stops_by_itself);
  EXPECT_THAT(model.loss_text, HasSubstr("try it"));
}

TEST(KincoMdOnCanopen, IsGuardedAndMadeToMindIt) {
  const model::DriveModel model = on_canopen("kinco-md");
  EXPECT_THAT(setup_of(model), ElementsAre(Raw::value_type{"controlword", 6}, Raw::value_type{"producer_heartbeat", 0},
                                           Raw::value_type{"guard_time", 500}, Raw::value_type{"life_time_factor", 3},
                                           Raw::value_type{"communication_loss_reaction", 1}));
  EXPECT_THAT(names(model, model.loss_objects),
              ElementsAre("guard_time", "life_time_factor", "communication_loss_reaction"));
  EXPECT_EQ(model.canopen.guard_time, milliseconds(500));
  EXPECT_EQ(model.canopen.life_factor, 3);
  EXPECT_EQ(model.canopen.heartbeat, Duration{}) << "heartbeat or guarding, not both";
  EXPECT_EQ(model.canopen.own_heartbeat, Duration{});
  EXPECT_TRUE(model.stops_by_itself);
  EXPECT_THAT(resolved(shipped("kinco-md"), kinco_axis()).setup, IsEmpty()) << "on its own protocol";
}

TEST(KincoOnCanopen, StateAndPositionComeTogether) {
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    const model::DriveModel model = on_canopen(drive);
    ASSERT_FALSE(model.canopen.tpdos.empty());
    EXPECT_THAT(names(model, model.canopen.tpdos[0].map),
                testing::UnorderedElementsAre("statusword", "position_actual"));
    EXPECT_EQ(model.canopen.tpdos.size() + model.canopen.unused_tpdos.size(), 4U);
  }
}

TEST(KincoOnCanopen, InhibitTimesAreInTheUnitsOfTheDrive) {
  const model::TpdoProperties jd = on_canopen("kinco-jd").canopen.tpdos.at(0);
  EXPECT_EQ(jd.inhibit, 50) << "of 100 us";
  EXPECT_EQ(jd.event_ms, std::nullopt);
  const model::TpdoProperties md = on_canopen("kinco-md").canopen.tpdos.at(0);
  EXPECT_EQ(md.inhibit, 5) << "of 1 ms";
  EXPECT_EQ(md.event_ms, 20);
  EXPECT_EQ(jd.inhibit_time, milliseconds(5));
  EXPECT_EQ(md.inhibit_time, milliseconds(5));
}

TEST(CanopenIdentity, IsWhatTheConfigurationAsksFor) {
  ResolveInput input = one_axis("canopen");
  EXPECT_FALSE(resolved(shipped("kinco-jd"), input).canopen.identity_given());
  input.identity[3] = 77;
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  EXPECT_TRUE(model.canopen.identity_given());
  EXPECT_THAT(model.canopen.identity, ElementsAre(std::nullopt, std::nullopt, std::nullopt, 77U));
}

TEST_F(CanopenProfile, SaysNothingThatItDoesNotSay) {
  const model::DriveModel plain = model();
  EXPECT_EQ(plain.canopen.confirm, milliseconds(1000));
  EXPECT_EQ(plain.canopen.sync, Duration{});
  EXPECT_EQ(plain.canopen.boot, Duration{});
  EXPECT_FALSE(plain.canopen.sdo_block || plain.stops_by_itself);
  ASSERT_EQ(plain.canopen.tpdos.size(), 1U);
  EXPECT_EQ(plain.canopen.tpdos[0].number, 2);
  EXPECT_EQ(plain.canopen.tpdos[0].type, 255);
  EXPECT_EQ(plain.canopen.tpdos[0].inhibit, std::nullopt) << "left as it is";
}

TEST_F(CanopenProfile, EveryKeyArrives) {
  canopen().update({{"sync_ms", 10}, {"boot_ms", 3000}, {"sdo_block", true}, {"confirm_ms", 250}});
  canopen()["tpdo"][0].update({{"type", 4}, {"inhibit_us", 250}});
  canopen()["unused_tpdos"] = {1, 3};
  canopen()["guard"] = {{"time_ms", 200}, {"life_factor", 5}};
  const model::CanopenProperties facts = model().canopen;
  EXPECT_EQ(facts.sync, milliseconds(10));
  EXPECT_EQ(facts.boot, milliseconds(3000));
  EXPECT_EQ(facts.confirm, milliseconds(250));
  EXPECT_TRUE(facts.sdo_block);
  EXPECT_EQ(facts.tpdos.at(0).type, 4);
  EXPECT_EQ(facts.tpdos.at(0).inhibit, 3) << "never more often than asked for";
  EXPECT_EQ(facts.tpdos.at(0).inhibit_time, microseconds(300));
  EXPECT_THAT(facts.unused_tpdos, ElementsAre(1, 3));
  EXPECT_EQ(facts.guard_time, milliseconds(200));
  EXPECT_EQ(facts.life_factor, 5);
}

TEST_F(CanopenProfile, GuardingWithoutALossReactionWritesNothing) {
  canopen()["guard"] = {{"time_ms", 200}};
  const model::DriveModel guarded = model();
  EXPECT_THAT(guarded.setup, IsEmpty());
  EXPECT_FALSE(guarded.stops_by_itself) << "the gateway notices, the drive does not";
}

TEST_F(CanopenProfile, ANumberInThePlaceOfFactoryNumbersNeedsNoUnit) {
  profile_["objects"]["option"] = {{"type", "i16"}, {"access", "rw"}, {"at", {{"canopen", "605A.00"}}}};
  profile_["setup"] = {{{"write", "option"}, {"value", 2}, {"instead_of", {0, -1}}, {"why", "coasts otherwise"}}};
  const model::DriveModel plain = model();
  EXPECT_THAT(plain.setup, IsEmpty()) << "never written without a look at what the drive holds";
  const auto due = [&](std::int64_t held) {
    return model::setup_writes(plain, [&](model::ObjectId) { return std::optional(held); });
  };
  for (const std::int64_t factory : {0, -1}) {
    ASSERT_EQ(due(factory).size(), 1U);
    EXPECT_EQ(due(factory)[0].raw, 2);
    EXPECT_EQ(due(factory)[0].why, "coasts otherwise");
  }
  EXPECT_THAT(due(2), IsEmpty()) << "it is not due again";
  EXPECT_THAT(due(6), IsEmpty());
}

TEST_F(CanopenProfile, AWidthThatNobodyPrintedIsOnlyAskedForOnCanopen) {
  profile_["objects"]["mystery"] = {{"type", "u32"}, {"any_width", true}, {"at", {{"canopen", "2008.00"}}}};
  const model::DriveModel plain = model();
  EXPECT_TRUE(plain.object(plain.find({0x2008, 0})).any_width);
  EXPECT_FALSE(plain.object(plain.find({0x6041, 0})).any_width);
}

TEST_F(CanopenProfile, AnIdentityIsOfItsVendorUnlessTheConfigurationSaysMore) {
  profile_["identity"] = {{"vendor", "0x000000FB"}, {"product", {"0x63500000", "0x64500000"}}};
  EXPECT_THAT(model().canopen.identity, ElementsAre(0xFBU, std::nullopt, std::nullopt, std::nullopt));
  ResolveInput input = one_axis("canopen");
  input.identity = {0xFBU, 0x64500000U, 7U, std::nullopt};
  EXPECT_EQ(resolved(load(), input).canopen.identity, input.identity);
  profile_.erase("identity");
  EXPECT_FALSE(model().canopen.identity_given()) << "it names nobody";
}

TEST_F(CanopenProfile, AConfiguredIdentityThatItIsNotForIsRefused) {
  profile_["identity"] = {{"vendor", 251}, {"product", {1, 2}}};
  const auto told = [&](std::array<std::optional<std::uint32_t>, 4> identity) {
    ResolveInput input = one_axis("canopen");
    input.identity = identity;
    return text(std::get<std::vector<Fault>>(resolve(load(), input)));
  };
  EXPECT_THAT(told({252U, {}, {}, {}}),
              HasSubstr("/identity/vendor: is 0x000000fc, but profile \"canopen-only\" is for 0x000000fb: for this "
                        "drive take its own maker's profile, \"cia402-generic\", or one of yours"));
  EXPECT_THAT(told({251U, 3U, {}, {}}), HasSubstr("/identity/product: is 0x00000003, but profile \"canopen-only\" is "
                                                  "for 0x00000001, 0x00000002: "));
}

}  // namespace
}  // namespace axisgate::profile
