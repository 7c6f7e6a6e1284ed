// Every CANopen frame of the three sheets that a node can answer, read from tests/vectors.
#include <gmock/gmock.h>

#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

struct Sheet {
  const char* name;
  int requests;
  int replies;
};

CanDriveOptions drive_of(const Sheet& sheet, std::uint8_t node, bool zeros = false) {
  const std::string name = sheet.name;
  if (name == "leadshine-ld2-can") return a_leadshine(node);
  KincoCanDrive drive = a_can_kinco(name == "kinco-jd" ? KincoType::jd : KincoType::md, node);
  drive.can.echoes_written = !zeros;
  drive.can.first_word_needed = false;
  return drive;
}

std::uint32_t hex_number(const nlohmann::json& text) {
  return static_cast<std::uint32_t>(std::stoul(text.get<std::string>(), nullptr, 16));
}

ObjectKey key_in(const nlohmann::json& row) {
  return {static_cast<std::uint16_t>(hex_number(row.at("index"))), row.at("sub").get<std::uint8_t>()};
}

std::string hex_of(const nlohmann::json& vector) { return vector.value("hex_padded", vector.at("hex")); }

class CanVectors : public testing::TestWithParam<Sheet> {
 protected:
  template <class Visit>
  void each(const char* protocol, const char* direction, Visit visit) {
    const auto rows = can_sheet(GetParam().name, "vectors");
    for (const auto& vector : rows) {
      if (vector.at("protocol") != protocol || vector.at("direction") != direction) continue;
      if (!vector.value("well_formed", true)) continue;
      SCOPED_TRACE(vector.at("id").get<std::string>());
      visit(vector);
    }
  }
};

TEST_P(CanVectors, EveryRequestOfTheSheetIsUnderstoodAndAnswered) {
  int requests = 0;
  each("canopen-sdo", "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const ObjectKey key = key_in(decoded);
    const auto node = static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - cob::sdo_request);
    CanBench bench(drive_of(GetParam(), node));
    if (key.index >= 0x1400 && key.index < 0x1C00 && key.sub <= 2) {
      for (const int area : {0x1400, 0x1800}) {  // as the steps before have left it
        const auto at = static_cast<std::uint16_t>(area + (key.index & 0x1FF));
        ASSERT_EQ(bench.write(at, 1, *bench.read(at, 1, node) | 0x80000000U, node), 0U);
      }
      if (key.index >= 0x1600 && key.sub == 0) {
        const auto map = static_cast<std::uint16_t>(key.index);
        ASSERT_EQ(bench.write(map, 1, 0x60400010, node), 0U);
        ASSERT_EQ(bench.write(map, 2, 0x607A0020, node), 0U);
      }
    }
    const Bytes request = from_hex(hex_of(vector));
    const auto reply = bench.sdo(request, node);
    ++requests;
    ASSERT_TRUE(reply.has_value());
    ASSERT_EQ(reply->size(), 8U);
    EXPECT_EQ(Bytes(reply->begin() + 1, reply->begin() + 4), Bytes(request.begin() + 1, request.begin() + 4));
    if (!bench.node().peek(key, bench.now)) {
      EXPECT_EQ((*reply)[0], 0x80);
    } else if (decoded.at("op") == "read") {
      EXPECT_THAT((*reply)[0], testing::AnyOf(0x43, 0x4B, 0x4F));
    } else if (key.index == 0x4000 || key.index == 0x3002) {
      EXPECT_EQ((*reply)[0], 0x60);
    } else {
      EXPECT_EQ((*reply)[0], 0x60);
      const auto size = decoded.at("size").get<std::ptrdiff_t>();
      EXPECT_EQ(bench.node().peek(key, bench.now), CanBytes(request.begin() + 4, request.begin() + 4 + size));
    }
  });
  EXPECT_GE(requests, GetParam().requests);
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(CanVectors, EveryReplyOfTheSheetIsReproduced) {
  int replies = 0;
  each("canopen-sdo", "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const ObjectKey key = key_in(decoded);
    const auto node = static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - cob::sdo_reply);
    const Bytes expected = from_hex(hex_of(vector));
    CanBench bench(drive_of(GetParam(), node, expected[4] == 0 && expected[5] == 0));
    if (decoded.at("op") == "error") {
      const ObjectKey wrong = bench.node().peek(key, bench.now) ? ObjectKey{0x9999, 0} : key;
      const auto reply = bench.sdo(CanBench::request(0x40, wrong.index, wrong.sub, 0), node);
      ASSERT_TRUE(reply.has_value());
      EXPECT_EQ((*reply)[0], 0x80);
      EXPECT_EQ(Bytes(reply->begin() + 4, reply->end()), Bytes(expected.begin() + 4, expected.end()));
      ++replies;
    } else if (decoded.at("op") == "read-ok") {
      const auto value = decoded.value("value_signed", decoded.value("value", std::int64_t{0}));
      if (bench.node().poke(key, value, bench.now) != 0) return;  // measured: see leadshine_test, sequences_test
      EXPECT_EQ(bench.sdo(CanBench::request(0x40, key.index, key.sub, 0), node), expected);
      ++replies;
    } else {
      const auto found = bench.node().peek(key, bench.now);
      ASSERT_TRUE(found.has_value());
      const std::size_t size = found->size();
      const auto value = little_endian(CanView(expected).subspan(4));
      // Any value that the object takes: the acknowledgement is the same but for an echo.
      for (const std::uint32_t tried : {value, std::uint32_t{1}, std::uint32_t{0x5A5A}, little_endian(*found)}) {
        const auto command = static_cast<std::uint8_t>(0x23 | (4 - size) << 2);
        const auto reply = bench.sdo(CanBench::request(command, key.index, key.sub, tried), node);
        ASSERT_TRUE(reply.has_value());
        if ((*reply)[0] == 0x80) continue;
        EXPECT_EQ(*reply, expected);
        ++replies;
        return;
      }
    }
  });
  EXPECT_GE(replies, GetParam().replies);
}

TEST_P(CanVectors, NmtCommandsHeartbeatsAndGuardingAreThoseOfTheSheet) {
  const std::map<std::uint8_t, NmtState> leads_to{{0x01, NmtState::operational},
                                                  {0x02, NmtState::stopped},
                                                  {0x80, NmtState::pre_operational},
                                                  {0x81, NmtState::initialising},
                                                  {0x82, NmtState::pre_operational}};
  int checked = 0;
  each("canopen-nmt", "request", [&](const nlohmann::json& vector) {
    const Bytes command = from_hex(vector.at("hex").get<std::string>());
    const std::uint8_t node = command.at(1) == 0 ? std::uint8_t{3} : command[1];
    CanBench bench(drive_of(GetParam(), node));
    bench.nmt(0x01, node);
    bench.send(bus_frame(cob::nmt, command));
    EXPECT_EQ(bench.node().state(), leads_to.at(command[0]));
    ++checked;
  });
  const std::map<std::string, std::uint8_t> command_to{{"05", 0x01}, {"04", 0x02}, {"7F", 0x80}};
  each("canopen-heartbeat", "response", [&](const nlohmann::json& vector) {
    const auto node = static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - cob::error_control);
    CanBench bench(drive_of(GetParam(), node));
    const std::string hex = vector.at("hex");
    const Bytes expected = from_hex(hex);
    ++checked;
    if (hex == "00") {
      bench.nmt(0x82, node);
    } else {
      ASSERT_EQ(bench.write(0x1017, 0, 100, node), 0U);
      bench.nmt(command_to.at(hex), node);
      bench.received.clear();
      bench.pass(milliseconds(100));
    }
    EXPECT_THAT(bench.heard(cob::error_control + node), testing::Contains(expected));
  });
  each("canopen-guard", "response", [&](const nlohmann::json& vector) {
    CanBench bench(drive_of(GetParam(), 1));
    const Bytes expected = from_hex(vector.at("hex").get<std::string>());
    bench.nmt((expected[0] & 0x7F) == 5 ? 0x01 : 0x80);
    const int before = vector.at("decoded").at("toggle").get<int>();
    for (int i = 0; i < before; ++i) (void)bench.exchange(bus_remote_frame(cob::error_control + 1));
    EXPECT_THAT(bench.exchange(bus_remote_frame(cob::error_control + 1)), testing::ElementsAre(expected));
    ++checked;
  });
  EXPECT_GE(checked, 4);
}

// Printed by JD 8.3 and MD 10.3: six bytes for objects of two bytes or less.
TEST(CanVectorsOfKinco, ShortFramesAreAcceptedAndSentWhereSwitchedOn) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    KincoCanDrive drive = a_can_kinco(type);
    drive.can.short_frames = true;
    CanBench bench(drive);
    EXPECT_EQ(bench.sdo(from_hex("2B 40 60 00 06 00")), from_hex("60 40 60 00 06 00"));
    EXPECT_EQ(bench.sdo(from_hex("2F 60 60 00 06 00")), from_hex("60 60 60 00 06 00"));
    EXPECT_EQ(bench.sdo(from_hex("23 7A 60 00 50 C3 00 00")), from_hex("60 7A 60 00 50 C3 00 00"));
    EXPECT_EQ(bench.sdo(from_hex("40 60 60 00")), from_hex("4F 60 60 00 06 00"));
  }
}

TEST(CanVectorsOfLeadshine, EveryObjectOfTheSheetIsThere) {
  CanBench bench(a_leadshine());
  const auto rows = can_sheet("leadshine-ld2-can", "objects");
  int objects = 0;
  for (const auto& row : rows) {
    const ObjectKey key{static_cast<std::uint16_t>(hex_number(row.at("index"))),
                        row.at("sub").is_null() ? std::uint8_t{0} : row.at("sub").get<std::uint8_t>()};
    // Named only, and not needed by anybody: cycle, window, TIME, EMCY inhibit.
    if (key.index == 0x1006 || key.index == 0x1007 || key.index == 0x1012 || key.index == 0x1013) continue;
    if (key.index == 0x1015) continue;
    SCOPED_TRACE(row.dump());
    const auto found = bench.node().peek(key, bench.now);
    ASSERT_TRUE(found.has_value());
    ++objects;
    if (!row.at("bits").is_null() && key.index >= 0x2000) {
      EXPECT_EQ(8 * found->size(), row.at("bits").get<std::size_t>());
    }
  }
  EXPECT_GE(objects, 290);
}

INSTANTIATE_TEST_SUITE_P(Drives, CanVectors,
                         testing::Values(Sheet{"leadshine-ld2-can", 70, 25}, Sheet{"kinco-jd", 24, 17},
                                         Sheet{"kinco-md", 16, 15}),
                         [](const auto& sheet) {
                           const std::string name = sheet.param.name;
                           return name == "leadshine-ld2-can" ? "ld2" : name.substr(6);
                         });

}  // namespace
}  // namespace axisgate::simulated
