// Every RS232 frame of both sheets against the simulated drives, read from tests/vectors.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

nlohmann::json sheet(const std::string& name, const std::string& part) {
  std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
  return nlohmann::json::parse(file).at(part);
}

struct Sheet {
  KincoType type;
  const char* name;
};

class RsVectors : public testing::TestWithParam<Sheet> {};

std::uint32_t hex_number(const nlohmann::json& text) {
  return static_cast<std::uint32_t>(std::stoul(text.get<std::string>(), nullptr, 16));
}

ObjectKey key_in(const nlohmann::json& row) {
  return {static_cast<std::uint16_t>(hex_number(row.at("index"))), row.at("sub").get<std::uint8_t>()};
}

TEST_P(RsVectors, EveryRequestIsAnsweredAndEveryBadOneMeetsSilence) {
  int requests = 0;
  const auto rows = sheet(GetParam().name, "vectors");
  for (const auto& vector : rows) {
    if (vector.at("protocol") != "kinco-rs232" || vector.at("direction") != "request") continue;
    SCOPED_TRACE(vector.at("id").get<std::string>());
    Bench bench(a_drive(GetParam().type));
    const Bytes reply = bench.exchange(from_hex(vector.at("hex").get<std::string>()));
    ++requests;
    if (!vector.at("checksum_ok").get<bool>()) {
      EXPECT_TRUE(reply.empty());
      continue;
    }
    const auto& decoded = vector.at("decoded");
    const ObjectKey key = key_in(decoded);
    if (bench.drive().peek(key) == std::nullopt) {  // 6510.0C is the MD's alone
      ASSERT_EQ(reply.size(), frame_length);
      EXPECT_EQ(reply[1], 0x80);
      continue;
    }
    ASSERT_EQ(reply.size(), frame_length);
    EXPECT_EQ(reply[0], decoded.at("station").get<int>());
    EXPECT_EQ(Bytes(reply.begin() + 2, reply.begin() + 5), from_hex(vector.at("hex").get<std::string>().substr(6, 8)));
    if (decoded.at("op") == "read") {
      EXPECT_THAT(reply[1], testing::AnyOf(0x43, 0x4B, 0x4F));
    } else {
      EXPECT_EQ(reply[1], 0x60);
      EXPECT_EQ(Bytes(reply.begin() + 5, reply.begin() + 9),
                from_hex(vector.at("hex").get<std::string>().substr(15, 11)));
    }
  }
  EXPECT_GE(requests, GetParam().type == KincoType::jd ? 31 : 30);
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(RsVectors, EveryReplyIsReproduced) {
  int replies = 0;
  const auto rows = sheet(GetParam().name, "vectors");
  for (const auto& vector : rows) {
    const auto& decoded = vector.at("decoded");
    if (vector.at("protocol") != "kinco-rs232" || vector.at("direction") != "response") continue;
    if (!decoded.contains("index")) continue;  // the cascade stream: see chain_test
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const ObjectKey key = key_in(decoded);
    if (key.index == 0x6041 || key.index == 0x6063) continue;  // measured: see sequences_test
    const Bytes expected = from_hex(vector.at("hex").get<std::string>());
    DriveOptions options = a_drive(GetParam().type);
    options.echo_written_value = expected[5] != 0 || expected[6] != 0;
    Bench bench(options);
    ++replies;
    if (decoded.at("op") == "error") {
      const ObjectKey wrong = bench.drive().peek(key) ? ObjectKey{0x9999, 0} : key;
      const Bytes reply = bench.exchange(seal(1, FrameCommand::read, wrong.index, wrong.sub, 0));
      ASSERT_EQ(reply.size(), frame_length);
      EXPECT_EQ(reply[1], 0x80);
      EXPECT_EQ(Bytes(reply.begin() + 5, reply.begin() + 9), Bytes(expected.begin() + 5, expected.begin() + 9));
      continue;
    }
    const auto value = decoded.value("value_signed", decoded.value("value", std::int64_t{0}));
    if (decoded.at("op") == "read-ok") {
      ASSERT_EQ(bench.drive().poke(key, value), Refusal::none);
      EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, key.index, key.sub, 0)), expected);
    } else {
      const auto command = key.index == 0x607A ? FrameCommand::write_4 : FrameCommand::write_2;
      const auto written = options.echo_written_value ? value : 0x2F;
      EXPECT_EQ(bench.exchange(seal(1, command, key.index, key.sub, static_cast<std::uint32_t>(written))), expected);
    }
  }
  EXPECT_GE(replies, 4);
}

TEST_P(RsVectors, EveryObjectOfTheSheetHasItsWidthAndAccess) {
  Bench bench(a_drive(GetParam().type));
  int objects = 0;
  const auto rows = sheet(GetParam().name, "objects");
  for (const auto& row : rows) {
    const ObjectKey key = key_in(row);
    if (key == ObjectKey{0x2F80, 1} || key == ObjectKey{0x1010, 3}) continue;  // a misprint; a screen only
    SCOPED_TRACE(row.dump());
    const auto answer = bench.ask(FrameCommand::read, key.index, key.sub, 0);
    ASSERT_TRUE(answer.has_value());
    ++objects;
    if (!row.at("bits").is_null()) {
      const int bits = row.at("bits").get<int>();
      EXPECT_EQ(answer->command, bits == 32   ? FrameCommand::read_4
                                 : bits == 16 ? FrameCommand::read_2
                                              : FrameCommand::read_1);
    }
    ASSERT_NE(answer->command, FrameCommand::error);
    const bool read_only = row.at("access") == "RO" || row.at("access") == "RM";
    if (read_only) {
      EXPECT_EQ(bench.ask(FrameCommand::write_2, key.index, key.sub, 0)->data, 0x06010002U);
    }
  }
  EXPECT_GE(objects, 125);
}

TEST_P(RsVectors, SpeedAndAccelerationFollowThePrintedConversions) {
  int checked = 0;
  const auto rows = sheet(GetParam().name, "conversions");
  for (const auto& row : rows) {
    if (!row.contains("exact") || !row.at("exact").is_number()) continue;
    const double exact = row.at("exact").get<double>();
    const std::string text = row.at("engineering").get<std::string>();
    double amount = 0;
    int counts = 0;
    if (row.at("quantity") == "speed" && (std::sscanf(text.c_str(), "%lf rpm, enc %d", &amount, &counts) == 2 ||
                                          std::sscanf(text.c_str(), "%lf rpm, resolution %d", &amount, &counts) == 2)) {
      EXPECT_EQ(speed_dec(static_cast<std::int64_t>(amount), counts), std::llround(exact)) << text;
      ++checked;
    }
    if (row.at("quantity") == "acceleration" && amount == 0 &&
        (std::sscanf(text.c_str(), "%lf rps/s, enc %d", &amount, &counts) == 2 ||
         std::sscanf(text.c_str(), "%lf rps/s, resolution %d", &amount, &counts) == 2) &&
        amount == static_cast<double>(static_cast<int>(amount))) {
      EXPECT_EQ(acceleration_dec(static_cast<std::int64_t>(amount), counts), std::llround(exact)) << text;
      ++checked;
    }
  }
  EXPECT_GE(checked, 5);
}

INSTANTIATE_TEST_SUITE_P(Kinco, RsVectors,
                         testing::Values(Sheet{KincoType::jd, "kinco-jd"}, Sheet{KincoType::md, "kinco-md"}),
                         [](const auto& sheet) { return sheet.param.type == KincoType::jd ? "jd" : "md"; });

}  // namespace
}  // namespace axisgate::simulated
