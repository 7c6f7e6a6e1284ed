// SPDX-License-Identifier: Apache-2.0
// The scan of a serial line against stations written down here: who is found, what is asked, and that it is reads
// alone.
#include "gateway/commands/scan/plan/serial_scan_plan.hpp"

#include <gmock/gmock.h>

#include <set>

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "gateway/core/rtu_crc.hpp"
#include "tests/stage/profile_once.hpp"

namespace axisgate::commands {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<profile::Profile> shipped() {
  std::vector<profile::Profile> out;
  for (const char* name : {"id286pro", "keya-kydas4860-2e", "kinco-jd", "kinco-md", "leadshine-ld2-can"})
    out.push_back(test::shipped_profile(name).profile);
  return out;
}

/// A drive of this profile, as it speaks.
struct Station {
  SerialSpeech speech;
  std::uint8_t number = 0;
  std::string profile;
  int answers_left = 100000;
};

struct Asked {
  SerialSpeech speech;
  bus::Exchange exchange;
};

std::vector<Asked> run(SerialScanPlan& plan, std::vector<Station> stations = {}) {
  std::vector<Asked> out;
  while (const auto exchange = plan.next()) {
    const SerialSpeech speech = plan.speech().value();
    EXPECT_EQ(exchange->access, bus::Access::read) << "a scan never writes";
    out.push_back({speech, *exchange});
    bus::ExchangeResult result;
    result.code = Errc::timed_out;
    for (Station& station : stations) {
      if (station.speech != speech || station.number != exchange->node || station.answers_left-- <= 0) continue;
      result.code = Errc::refused_by_drive;
      for (const profile::Object& object : test::shipped_profile(station.profile).profile.objects) {
        const auto place = object.places.find(speech.protocol);
        if (place == object.places.end() || !(place->second.address == exchange->object)) continue;
        result.code = Errc::ok;
        result.fields.push_back({exchange->object, place->second.size, 1});
        break;
      }
    }
    plan.on_result(result);
  }
  return out;
}

TEST(SerialScan, FindsEachStationAtItsRateAndProtocolWithTheProfileThatFits) {
  SerialScanPlan plan(shipped(), {});
  run(plan, {{{"kinco-serial", 38400}, 3, "kinco-jd"},
             {{"modbus-rtu", 9600}, 31, "id286pro"},
             {{"modbus-rtu", 19200}, 1, "kinco-md"}});
  ASSERT_THAT(plan.found(), SizeIs(3));
  EXPECT_EQ(plan.found()[0].fits.front().profile, "kinco-jd");
  EXPECT_EQ(plan.found()[0].station, 3);
  EXPECT_EQ(plan.found()[1].fits.front().profile, "kinco-md");
  EXPECT_EQ(plan.found()[2].speech, (SerialSpeech{"modbus-rtu", 9600}));
  EXPECT_EQ(plan.found()[2].fits.front().has, plan.found()[2].fits.front().of);
}

TEST(SerialScan, TellsBeforeHowManyReadsItSendsAtMost) {
  SerialScanPlan plan(shipped(), {});
  const int said = plan.knocks();
  EXPECT_EQ(longest_silence(plan, std::chrono::milliseconds(100)), said * std::chrono::milliseconds(100));
  EXPECT_THAT(run(plan), SizeIs(said));
  EXPECT_EQ(plan.knocked(), said);
  EXPECT_EQ(said, 4 * 32 * 3) << "one read for both Kincos in each protocol, one for the iD286pro";
  EXPECT_THAT(plan.found(), IsEmpty());
}

TEST(SerialScan, WhereSomebodyAnswersItsCountIsRightAllTheSame) {
  SerialScanPlan plan(shipped(), {});
  run(plan, {{{"modbus-rtu", 38400}, 1, "kinco-jd"}, {{"modbus-rtu", 38400}, 2, "id286pro"}});
  EXPECT_EQ(plan.knocked(), plan.knocks());
}

TEST(SerialScan, AsksOnlyStationsThatAProtocolHas) {
  SerialScanPlan plan(shipped(), {.bauds = {38400}, .stations = {120, 247}});
  std::set<int> kinco, rtu;
  for (const Asked& asked : run(plan))
    (asked.speech.protocol == "kinco-serial" ? kinco : rtu).insert(asked.exchange.node);
  EXPECT_EQ(*kinco.rbegin(), 126) << "127 reaches every drive";
  EXPECT_EQ(*rtu.rbegin(), 247);
  SerialScanPlan none(shipped(), {.protocols = {"kinco-serial"}, .stations = {127, 130}});
  EXPECT_FALSE(none.next());
  EXPECT_EQ(none.knocks(), 0);
}

TEST(SerialScan, AStationThatFallsSilentIsLeft) {
  SerialScanPlan plan(shipped(), {.protocols = {"kinco-serial"}, .bauds = {38400}, .stations = {1, 2}});
  run(plan, {{{"kinco-serial", 38400}, 1, "kinco-jd", 5}, {{"kinco-serial", 38400}, 2, "kinco-md"}});
  ASSERT_THAT(plan.found(), SizeIs(2));
  EXPECT_TRUE(plan.found()[0].fell_silent);
  EXPECT_THAT(serial_scan_table(plan.found(), "/dev/ttyUSB0"), HasSubstr("station 1: it fell silent"));
  EXPECT_EQ(plan.found()[1].fits.front().profile, "kinco-md");
}

TEST(SerialScan, ADriveThatNoProfileFitsIsShownAllTheSame) {
  SerialScanPlan plan(shipped(), {.protocols = {"modbus-rtu"}, .bauds = {9600}, .stations = {9, 9}});
  while (plan.next()) {
    bus::ExchangeResult refused;
    refused.code = Errc::refused_by_drive;
    plan.on_result(refused);
  }
  EXPECT_THAT(serial_scan_table(plan.found(), "/dev/ttyUSB0"), HasSubstr("modbus-rtu      9600        9  none fits\n"));
}

/// A Kinco drive hears ten bytes whose sum is right, wherever they begin: what the scan says in the other protocol on
/// its line must not be a write either.
TEST(SerialScan, ReadsOfTheOtherProtocolAreNoKincoWriteWhereverOneBegins) {
  SerialScanPlan plan(shipped(), {.bauds = {38400}, .stations = {1, 247}});
  std::vector<Byte> line;
  for (const Asked& asked : run(plan)) {
    if (asked.speech.protocol == "kinco-serial") {
      const auto frame = kinco::encode(kinco::request_of(asked.exchange));
      line.insert(line.end(), frame.begin(), frame.end());
    } else {
      std::vector<Byte> frame{asked.exchange.node,
                              0x03,
                              static_cast<Byte>(asked.exchange.object.index >> 8),
                              static_cast<Byte>(asked.exchange.object.index & 0xFF),
                              0,
                              static_cast<Byte>(asked.exchange.size / 2)};
      const std::uint16_t crc = crc16(frame);
      frame.push_back(static_cast<Byte>(crc & 0xFF));
      frame.push_back(static_cast<Byte>(crc >> 8));
      line.insert(line.end(), frame.begin(), frame.end());
    }
  }
  EXPECT_EQ(plan.knocked(), plan.knocks());
  for (std::size_t at = 0; at + kinco::kFrameSize <= line.size(); ++at) {
    const auto heard = kinco::decode(Bytes(line).subspan(at, kinco::kFrameSize));
    const auto* frame = std::get_if<kinco::Frame>(&heard);
    if (frame == nullptr || !kinco::is_request(frame->command)) continue;
    EXPECT_EQ(frame->command, kinco::Command::read) << "at byte " << at;
  }
}

TEST(SerialScan, ProposesABusForEachProtocolAndRate) {
  SerialScanPlan plan(shipped(), {.bauds = {19200}, .stations = {1, 2}});
  run(plan, {{{"modbus-rtu", 19200}, 1, "id286pro"}, {{"modbus-rtu", 19200}, 2, "id286pro"}});
  EXPECT_THAT(
      serial_scan_table(plan.found(), "/dev/ttyUSB0"),
      HasSubstr("{\"name\": \"line\", \"adapter\": \"modbus-rtu\", \"device\": \"/dev/ttyUSB0\", \"baud\": 19200, "
                "\"drives\": [\n    {\"profile\": \"id286pro\", \"node\": 1, \"axes\": [{\"axis\": 1}]},\n    "
                "{\"profile\": \"id286pro\", \"node\": 2,"));
  EXPECT_THAT(serial_scan_table(plan.found(), "/dev/ttyUSB0"), HasSubstr("are yours to choose):\n"))
      << "nothing is to be filled in";
}

}  // namespace
}  // namespace axisgate::commands
