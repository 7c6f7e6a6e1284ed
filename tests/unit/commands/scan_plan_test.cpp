// SPDX-License-Identifier: Apache-2.0
// The scan against nodes written down here: who is found, in which order, what is read of them, and what fits.
#include "gateway/commands/scan/plan/scan_plan.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "gateway/commands/scan/plan/scan_table.hpp"
#include "tests/stage/profile_once.hpp"

namespace axisgate::commands {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

profile::Profile profile(const std::string& name) { return test::shipped_profile(name).profile; }

/// A node that has these objects.
struct Node {
  std::map<ObjectAddress, bus::ReplyField> objects;
  std::string name;
  int answers_left = 100000;  ///< then it falls silent

  void add(ObjectAddress address, std::uint8_t size, std::uint32_t raw = 0) { objects[address] = {address, size, raw}; }
  void add(const profile::Profile& like) {
    for (const profile::Object& object : like.objects)
      if (const auto at = object.places.find("canopen"); at != object.places.end() && object.readable)
        add(at->second.address, at->second.size);
  }
};

class Scan : public ::testing::Test {
 protected:
  bus::ExchangeResult answer(const bus::Exchange& exchange) {
    const auto node = nodes_.find(exchange.node);
    bus::ExchangeResult out;
    if (node == nodes_.end() || node->second.answers_left-- <= 0) {
      out.code = Errc::timed_out;
    } else if (exchange.object == ObjectAddress{0x1008, 0} && !node->second.name.empty()) {
      out.more = exchange.part == bus::Part::first;
      const std::string& name = node->second.name;
      if (!out.more) out.bytes = std::make_shared<std::vector<std::uint8_t>>(name.begin(), name.end());
    } else if (const auto object = node->second.objects.find(exchange.object); object != node->second.objects.end()) {
      out.fields.push_back(object->second);
    } else {
      out.code = Errc::refused_by_drive;
      out.detail = 0x06020000;
    }
    return out;
  }
  void run(ScanPlan& plan) {
    constexpr int kMost = 200000;
    for (int i = 0; i < kMost; ++i) {
      const auto exchange = plan.next();
      if (!exchange) return;
      EXPECT_EQ(exchange->access, bus::Access::read) << "a scan never writes";
      asked_.push_back(exchange->node);
      plan.on_result(answer(*exchange));
    }
    FAIL() << "the scan does not end";
  }
  static bus::UnsolicitedEvent sign_of_life(std::uint8_t node, bus::NodeState state) {
    bus::UnsolicitedEvent unsolicited;
    unsolicited.node = node;
    unsolicited.state = state;
    return unsolicited;
  }

  std::map<std::uint8_t, Node> nodes_;
  std::vector<std::uint8_t> asked_;
  const std::vector<profile::Profile> shipped_{profile("kinco-jd"), profile("kinco-md"), profile("leadshine-ld2-can"),
                                               profile("id286pro")};
};

TEST_F(Scan, OfAnEmptyBusAsksEachNodeOnce) {
  ScanPlan plan(shipped_);
  EXPECT_TRUE(plan.knocking());
  run(plan);
  EXPECT_THAT(asked_, SizeIs(127));
  EXPECT_EQ(plan.nodes_asked(), 127);
  EXPECT_THAT(plan.found(), IsEmpty());
}

TEST_F(Scan, FindsWhoSaysWhatItIs) {
  Node& node = nodes_[5];
  node.name = "LD2-CAN7015";
  node.add({0x1000, 0}, 4, 0x00020192);
  for (std::uint8_t sub = 1; sub <= 4; ++sub) node.add({0x1018, sub}, 4, sub * 100U);
  ScanPlan plan(shipped_);
  run(plan);
  ASSERT_THAT(plan.found(), SizeIs(1));
  const FoundNode found = plan.found()[0];
  EXPECT_EQ(found.node, 5);
  EXPECT_EQ(found.device_type, 0x00020192U);
  EXPECT_THAT(found.identity, ElementsAre(100U, 200U, 300U, 400U));
  EXPECT_EQ(found.name, "LD2-CAN7015");
  EXPECT_THAT(found.fits, IsEmpty()) << "it has none of the objects";
  EXPECT_EQ(scan_table({found}),
            "node  name         vendor      product     revision    serial      heartbeat  profile\n"
            "   5  LD2-CAN7015  0x00000064  0x000000c8  0x0000012c  0x00000190  -          none fits\n\n"
            "node 5: device type (1000h) 0x00020192: CiA 402\n");
}

TEST_F(Scan, ANodeThatRefusesEverythingIsThereAllTheSame) {
  nodes_[9] = {};
  ScanPlan plan(shipped_);
  run(plan);
  ASSERT_THAT(plan.found(), SizeIs(1));
  EXPECT_EQ(plan.found()[0].device_type, std::nullopt);
  EXPECT_EQ(scan_table(plan.found()),
            "node  name  vendor  product  revision  serial  heartbeat  profile\n"
            "   9  -     -       -        -         -       -          none fits\n");
}

TEST_F(Scan, EachShippedProfileFitsItsOwnDriveBest) {
  for (const std::string name : {"kinco-jd", "kinco-md", "leadshine-ld2-can"}) {
    nodes_.clear();
    nodes_[1].add(profile(name));
    ScanPlan plan(shipped_);
    run(plan);
    ASSERT_THAT(plan.found(), SizeIs(1));
    const std::vector<ScanFit> fits = plan.found()[0].fits;
    ASSERT_FALSE(fits.empty()) << name;
    EXPECT_EQ(fits[0].profile, name);
    EXPECT_EQ(fits[0].has, fits[0].of);
    if (fits.size() > 1) {
      EXPECT_LT(fits[1].has, fits[1].of) << fits[1].profile << " must not look as good";
    }
  }
}

TEST_F(Scan, AWidthThatNobodyPrintedMayBeAny) {
  Node& node = nodes_[1];
  node.add(profile("leadshine-ld2-can"));
  node.add({0x2008, 0}, 2);
  ScanPlan plan(shipped_);
  run(plan);
  const ScanFit fit = plan.found().at(0).fits.at(0);
  EXPECT_EQ(fit.has, fit.of);
}

TEST_F(Scan, AServerThatSaysNoSizesOrAnswersAllInFourBytesFitsByWhatItHas) {
  Node& node = nodes_[1];
  node.add(profile("leadshine-ld2-can"));
  for (auto& [address, field] : node.objects) field.size = 4;
  ScanPlan plan(shipped_);
  run(plan);
  ASSERT_FALSE(plan.found().at(0).fits.empty());
  const ScanFit fit = plan.found()[0].fits[0];
  EXPECT_EQ(fit.profile, "leadshine-ld2-can");
  EXPECT_EQ(fit.has, fit.of);
}

TEST_F(Scan, WhoIsHeardIsAskedFirst) {
  nodes_[100] = {};
  nodes_[3] = {};
  ScanPlan plan(shipped_);
  plan.heard(sign_of_life(100, bus::NodeState::operational));
  run(plan);
  EXPECT_EQ(asked_[0], 1) << "the one that was being asked";
  EXPECT_EQ(asked_[1], 100);
  ASSERT_THAT(plan.found(), SizeIs(2));
  EXPECT_EQ(plan.found()[0].node, 3) << "told in their order";
  EXPECT_EQ(plan.found()[1].state, bus::NodeState::operational);
  EXPECT_THAT(scan_table(plan.found()), HasSubstr("operational"));
}

TEST_F(Scan, ANodeThatFallsSilentIsLeft) {
  for (int answers = 1; answers < 40; ++answers) {
    nodes_.clear();
    nodes_[1].add(profile("kinco-jd"));
    nodes_[1].name = "JD";
    nodes_[1].answers_left = answers;
    nodes_[2].name = "alive";
    asked_.clear();
    ScanPlan plan(shipped_);
    run(plan);
    ASSERT_THAT(plan.found(), SizeIs(2)) << answers;
    EXPECT_TRUE(plan.found()[0].fell_silent);
    EXPECT_THAT(scan_table(plan.found()), HasSubstr("node 1: it fell silent"));
    EXPECT_EQ(std::count(asked_.begin(), asked_.end(), 1), answers + ScanPlan::kSilences);
    EXPECT_EQ(plan.found()[1].name, "alive");
    EXPECT_FALSE(plan.found()[1].fell_silent);
  }
}

TEST_F(Scan, ANameThatNeverEndsEndsAtItsBound) {
  nodes_[1] = {};
  ScanPlan plan({});
  std::size_t parts = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto exchange = plan.next();
    if (!exchange) break;
    bus::ExchangeResult result = answer(*exchange);
    if (exchange->node == 1 && exchange->object == ObjectAddress{0x1008, 0}) {
      ++parts;
      result = {};
      result.more = true;
    }
    plan.on_result(result);
  }
  EXPECT_EQ(plan.next(), std::nullopt);
  EXPECT_EQ(parts, ScanPlan::kMaxNameParts + 1);
}

TEST_F(Scan, AsksTheNodesOfItsRangeAlone) {
  for (std::uint8_t node = 1; node <= 10; ++node) nodes_[node] = {};
  ScanPlan plan(shipped_, {4, 6});
  plan.heard(sign_of_life(9, bus::NodeState::operational));
  run(plan);
  EXPECT_EQ(plan.nodes_asked(), 3);
  EXPECT_THAT(std::set<std::uint8_t>(asked_.begin(), asked_.end()), ElementsAre(4, 5, 6));
}

TEST_F(Scan, TellsOfADuplicateNodeIdAtAnyTime) {
  nodes_[1] = {};
  nodes_[2] = {};
  ScanPlan plan(shipped_);
  run(plan);
  bus::UnsolicitedEvent unsolicited = sign_of_life(2, bus::NodeState::unknown);
  unsolicited.kind = bus::UnsolicitedEvent::Kind::duplicate_node;
  plan.heard(unsolicited);
  EXPECT_FALSE(plan.found().at(0).duplicate);
  EXPECT_TRUE(plan.found().at(1).duplicate);
  EXPECT_THAT(scan_table(plan.found()), HasSubstr("node 2: two answers came to one request"));
}

TEST_F(Scan, ShowsHowAConfigurationMayBegin) {
  for (const std::uint8_t number : {std::uint8_t{3}, std::uint8_t{14}}) {
    Node& node = nodes_[number];
    node.add(profile(number == 3 ? "leadshine-ld2-can" : "kinco-md"));
    for (std::uint8_t sub = 1; sub <= 4; ++sub) node.add({0x1018, sub}, 4, number * 100U + sub);
  }
  nodes_[7] = {};  // nothing fits: nothing is proposed
  ScanPlan plan(shipped_);
  run(plan);
  const std::string table = scan_table(plan.found());
  EXPECT_THAT(
      table,
      HasSubstr("\n  {\"profile\": \"leadshine-ld2-can\", \"node\": 3, \"identity\": {\"vendor\": 301, \"product\": "
                "302}, \"axes\": [{\"axis\": 3}]},\n"
                "  {\"profile\": \"kinco-md\", \"node\": 14, \"identity\": {\"vendor\": 1401, \"product\": 1402}, "
                "\"constants\": {\n    \"peak_current_a\": \"FILL IN\", // peak current of the drive model in A: "
                "MD60-020 36"));
  EXPECT_THAT(table,
              HasSubstr("\n    \"rated_current_a\": \"FILL IN\" // rated current of the motor, from its name plate; "
                        "without it torque quantities are not supported\n  }, \"axes\": [{\"axis\": 14}]}\n"));
  EXPECT_THAT(table, HasSubstr("yours to choose; for each \"FILL IN\" write the number from the type plate of drive or "
                               "motor, or from the manual):\n"));
  EXPECT_THAT(table, Not(HasSubstr("fits best"))) << "where all of a profile is there, no other is worth a word";
}

TEST_F(Scan, NamesTheProfilesThatFitLessWhereNoneFitsWholly) {
  Node& node = nodes_[1];
  node.add(profile("kinco-jd"));
  node.add(profile("kinco-md"));  // an object that both have is as wide as the MD's
  node.add({0x6041, 0}, 4);
  ScanPlan plan(shipped_);
  run(plan);
  EXPECT_THAT(scan_table(plan.found()), HasSubstr("node 1: kinco-md fits best; less: kinco-jd ("));
}

/// A drive of CiA 402 that has what every one has, and what its vendor is.
class ScanOfAStranger : public Scan {
 protected:
  ScanOfAStranger() {
    profiles_.push_back(generic_);
    nodes_[5].add(generic_);
    nodes_[5].add({0x1000, 0}, 4, 0x00020192);
    nodes_[5].add({0x1018, 1}, 4, 0xFB);
    nodes_[5].add({0x1018, 2}, 4, 0x6350);
  }
  FoundNode found() {
    ScanPlan plan(profiles_);
    run(plan);
    return plan.found().at(0);
  }
  /// A user's profile with the objects that every drive has.
  profile::Profile named(const std::string& name, std::optional<profile::IdentitySpec> identity) {
    profile::Profile out = generic_;
    out.name = name;
    out.identity = std::move(identity);
    return out;
  }
  std::vector<std::string> proposed() {
    std::vector<std::string> out;
    for (const ScanFit& fit : found().fits) out.push_back(fit.profile);
    return out;
  }

  profile::Profile generic_ = profile("cia402-generic");
  std::vector<profile::Profile> profiles_ = shipped_;
};

TEST_F(ScanOfAStranger, GetsTheGenericProfileAndNeverAForeignMakers) {
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic"));
  const std::string table = scan_table({found()});
  EXPECT_THAT(table, HasSubstr("node 5: no profile is for this drive (vendor 0x000000fb): cia402-generic is for any "
                               "CiA 402 drive, and moves nothing before its units are known\n"));
  EXPECT_THAT(table, HasSubstr("{\"profile\": \"cia402-generic\", \"node\": 5, \"identity\": {\"vendor\": 251"));
  EXPECT_THAT(table, Not(HasSubstr("leadshine"))) << "although it has 28 of its objects";
}

TEST_F(ScanOfAStranger, GetsNoneWhereItIsNoDriveOfCia402) {
  nodes_[5].add({0x1000, 0}, 4, 0x00020191);
  EXPECT_THAT(proposed(), IsEmpty());
  EXPECT_THAT(scan_table({found()}), HasSubstr("none fits"));
}

TEST_F(ScanOfAStranger, AProfileOfAnotherVendorIsNeverProposedHoweverWellItFits) {
  profiles_.insert(profiles_.begin(), named("acme-servo", profile::IdentitySpec{{{{0xFC}, {}, {}}}}));
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic"));
  EXPECT_THAT(scan_table({found()}), Not(HasSubstr("acme-servo")));
  nodes_[5].objects.erase({0x1018, 1});
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic")) << "who does not say his vendor";
}

TEST_F(ScanOfAStranger, TheProfileThatNamesItsVendorComesFirst) {
  profiles_.push_back(named("acme-servo", profile::IdentitySpec{{{{0xFB}, {0x6350, 0x6450}, {}}}}));
  profiles_.back().only_simulated = true;
  EXPECT_THAT(proposed(), ElementsAre("acme-servo", "cia402-generic"));
  EXPECT_THAT(scan_table({found()}), HasSubstr("node 5: acme-servo: numbers from an EDS or a public list, never tried "
                                               "on the real drive\n"));
}

TEST_F(ScanOfAStranger, AProfileForAnotherProductOfItsVendorIsNamedAndNotProposed) {
  profiles_.push_back(named("acme-servo", profile::IdentitySpec{{{{0xFB}, {0x6450}, {}}}}));
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic"));
  EXPECT_THAT(scan_table({found()}),
              HasSubstr("node 5: for other products or revisions of this vendor there is acme-servo\n"));
}

TEST_F(ScanOfAStranger, AProfileThatNamesNobodyIsItsMakersByHisOwnObjects) {
  nodes_[5].add(profile("leadshine-ld2-can"));
  EXPECT_THAT(proposed(), ElementsAre("leadshine-ld2-can", "cia402-generic"));
  nodes_[5].objects.erase({0x3002, 0});
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic")) << "another maker's by a single one that is missing";
}

TEST_F(ScanOfAStranger, AProfileThatNamesNobodyAndShowsNobodyIsOnlyTold) {
  profiles_.push_back(named("acme-servo", std::nullopt));
  EXPECT_THAT(proposed(), ElementsAre("cia402-generic"));
  EXPECT_THAT(scan_table({found()}),
              HasSubstr("node 5: acme-servo would fit, but says of no vendor: its \"identity\" would\n"));
}

TEST(ScanRange, IsOneNodeOrTwoEnds) {
  EXPECT_EQ(parse_scan_range("5"), (ScanRange{5, 5}));
  EXPECT_EQ(parse_scan_range("1-127"), ScanRange{});
  EXPECT_EQ(ScanRange{}.count(), 127);
  for (const char* wrong : {"", "-", "0", "0-5", "1-128", "5-4", "1-", "-5", "1-2-3", "a", "1 - 5", "256"})
    EXPECT_EQ(parse_scan_range(wrong), std::nullopt) << wrong;
}

TEST_F(Scan, NamesAreShownWithoutWhatCannotBePrinted) {
  nodes_[1].name = "A\x1B[31m" + std::string(200, 'x');
  ScanPlan plan({});
  run(plan);
  const std::string name = plan.found().at(0).name;
  EXPECT_THAT(name, HasSubstr("A[31mxxx"));
  EXPECT_LE(name.size(), 64U);
}

}  // namespace
}  // namespace axisgate::commands
