// SPDX-License-Identifier: Apache-2.0
// Every frame, object, register and conversion of the two Kinco sheets against the simulated drives, on their own
// protocol and on Modbus RTU. What needs a motion is in scripts/kinco.txt.
#include <regex>

#include "tests/unit/simulated/sheets.hpp"

namespace axisgate::simulated {
namespace {

struct SerialSheet {
  const char* name;
  const char* drive;
  int requests;
};

class KincoSheet : public testing::TestWithParam<SerialSheet> {
 protected:
  std::string drive() const { return GetParam().drive; }
  nlohmann::json rows(const char* of) const { return sheet_of(GetParam().name, of); }
};

TEST_P(KincoSheet, every_request_of_the_serial_protocol_is_answered_and_every_bad_one_meets_silence) {
  const int requests = each_vector(GetParam().name, "kinco-rs232", "request", [&](const nlohmann::json& vector) {
    Bench bench(drive());
    const Bytes request = from_hex(vector.at("hex").get<std::string>());
    const Bytes reply = bench.exchange(request);
    ASSERT_EQ(reply.size(), vector.at("checksum_ok").get<bool>() ? frame_length : 0U);
    if (reply.empty()) return;
    const auto& decoded = vector.at("decoded");
    if (!bench.kinco()->peek(key_in(decoded))) {  // 6510.0C is the MD's alone
      EXPECT_EQ(reply[1], 0x80);
      return;
    }
    EXPECT_EQ(reply[0], decoded.at("station").get<int>());
    EXPECT_EQ(part(reply, 2, 5), part(request, 2, 5));
    if (decoded.at("op") == "read") {
      EXPECT_TRUE(is_read_reply(reply[1]));
    } else {
      EXPECT_EQ(reply[1], 0x60);
      EXPECT_EQ(part(reply, 5, 9), part(request, 5, 9));
    }
  });
  EXPECT_GE(requests, GetParam().requests);
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(KincoSheet, every_reply_of_the_serial_protocol_is_reproduced) {
  int replies = 0;
  each_vector(GetParam().name, "kinco-rs232", "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    if (!decoded.contains("index")) return;  // the cascade stream: scripts/kinco.txt
    const ObjectKey key = key_in(decoded);
    if (key.index == 0x6041 || key.index == 0x6063) return;  // measured: scripts/kinco.txt
    const Bytes expected = from_hex(vector.at("hex").get<std::string>());
    LineSpec spec = spec_of(drive());
    spec.drives[0].echo_written_value = expected[5] != 0 || expected[6] != 0;
    Bench bench(spec);
    ++replies;
    if (decoded.at("op") == "error") {
      const ObjectKey asked = bench.kinco()->peek(key) ? ObjectKey{0x9999, 0} : key;
      const Bytes reply = bench.exchange(ten_bytes(FrameCommand::read, asked));
      ASSERT_EQ(reply.size(), frame_length);
      EXPECT_EQ(reply[1], 0x80);
      EXPECT_EQ(part(reply, 5, 9), part(expected, 5, 9));
    } else if (decoded.at("op") == "read-ok") {
      ASSERT_EQ(bench.kinco()->poke(key, value_in(decoded)), Refusal::none);
      EXPECT_EQ(bench.exchange(ten_bytes(FrameCommand::read, key)), expected);
    } else {
      const auto command = key.index == 0x607A ? FrameCommand::write_4 : FrameCommand::write_2;
      const auto written = spec.drives[0].echo_written_value ? value_in(decoded) : 0x2F;
      EXPECT_EQ(bench.exchange(ten_bytes(command, key, static_cast<std::uint32_t>(written))), expected);
    }
  });
  EXPECT_GE(replies, 4);
}

TEST_P(KincoSheet, every_object_has_its_width_and_access) {
  Bench bench(drive());
  const std::map<int, std::uint8_t> commands{{32, 0x43}, {16, 0x4B}, {8, 0x4F}};
  int objects = 0;
  for (const auto& row : rows("objects")) {
    const ObjectKey key = key_in(row);
    if (key == ObjectKey{0x2F80, 1} || key == ObjectKey{0x1010, 3}) continue;  // a misprint; a screen only
    SCOPED_TRACE(row.dump());
    const Bytes answer = bench.exchange(ten_bytes(FrameCommand::read, key));
    ASSERT_EQ(answer.size(), frame_length);
    EXPECT_NE(answer[1], 0x80);
    EXPECT_TRUE(row.at("bits").is_null() || answer[1] == commands.at(row.at("bits").get<int>()));
    ++objects;
    if (row.at("access") != "RO" && row.at("access") != "RM") continue;
    const Bytes refusal = bench.exchange(ten_bytes(FrameCommand::write_2, key));
    EXPECT_EQ(little_endian(part(refusal, 5, 9)), 0x06010002U);
  }
  EXPECT_GE(objects, 125);
}

TEST_P(KincoSheet, speed_and_acceleration_follow_the_printed_conversions) {
  int checked = 0;
  for (const auto& row : rows("conversions")) {
    if (!row.contains("exact") || !row.at("exact").is_number()) continue;
    const std::string text = row.at("engineering").get<std::string>();
    static const std::regex form("(-?\\d+) (rpm|rps/s), (?:enc|resolution) (\\d+).*");
    std::smatch parts;
    const bool speed = row.at("quantity") == "speed";
    if (!std::regex_match(text, parts, form) || (parts[2] == "rpm") != speed) continue;
    const std::int64_t whole = std::stoll(parts[1]);
    const std::int64_t counts = std::stoll(parts[3]);
    const std::int64_t exact = std::llround(row.at("exact").get<double>());
    EXPECT_EQ(speed ? speed_dec(whole, counts) : acceleration_dec(whole, counts), exact) << text;
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

TEST_P(KincoSheet, every_frame_of_modbus_is_answered_and_every_bad_one_meets_silence) {
  const int requests = each_vector(GetParam().name, "modbus-rtu", "request", [&](const nlohmann::json& vector) {
    Bench bench("rtu:" + drive());
    const Bytes request = from_hex(vector.at("hex").get<std::string>());
    const Bytes reply = bench.exchange(request);
    const auto frame = open_rtu(reply);
    ASSERT_EQ(frame.has_value(), vector.at("checksum_ok").get<bool>());
    if (!frame) return;
    const bool reads = request[1] == 0x03;
    ASSERT_EQ(part(reply, 0, 2), part(request, 0, 2));
    EXPECT_TRUE(reads ? frame->pdu[1] == 2 * request[5] : part(reply, 0, 6) == part(request, 0, 6));
  });
  EXPECT_GE(requests, 25);
}

TEST_P(KincoSheet, every_register_reaches_its_object_and_no_other_exists) {
  const auto ask = [](Bench& whom, std::uint16_t at, int words) {
    const auto frame = open_rtu(whom.exchange(seal_rtu(1, read_pdu(at, static_cast<std::uint16_t>(words)))));
    return frame && frame->pdu[0] == function::read ? part(frame->pdu, 2, frame->pdu.size()) : Bytes{};
  };
  Bench bench("rtu:" + drive());
  LineSpec strict = spec_of("rtu:" + drive());
  std::get<KincoRtuDrive>(strict.rtu_drives[0]).rtu.serves_derived = false;
  std::map<std::uint16_t, int> registers;  // and how many words
  for (const auto& row : rows("objects")) {
    if (row.at("modbus").is_null()) continue;
    SCOPED_TRACE(row.dump());
    const auto number = static_cast<std::uint16_t>(hex_number(row.at("modbus")));
    const ObjectEntry* entry = bench.kinco()->entry(key_in(row));
    ASSERT_NE(entry, nullptr);
    const int words = registers[number] = bytes_of(entry->type) == 4 ? 2 : 1;
    const auto value = static_cast<std::uint32_t>(*bench.kinco()->peek(key_in(row)));
    RtuBytes expected;
    append_word(expected, static_cast<std::uint16_t>(value));
    if (words == 2) append_word(expected, static_cast<std::uint16_t>(value >> 16));
    EXPECT_EQ(ask(bench, number, words), expected);
    Bench printed(strict);
    EXPECT_EQ(ask(printed, number, words).empty(), row.at("modbus_origin") == "derived");
  }
  EXPECT_GE(registers.size(), 101U);
  for (std::uint32_t number = 0; number < 0x10000; number += 0x10) {
    const auto at = static_cast<std::uint16_t>(number);
    EXPECT_EQ(!ask(bench, at, 1).empty() || !ask(bench, at, 2).empty(), registers.contains(at)) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(sheets, KincoSheet,
                         testing::Values(SerialSheet{"kinco-jd", "jd", 31}, SerialSheet{"kinco-md", "md", 30}),
                         [](const auto& sheet) { return sheet.param.drive; });

}  // namespace
}  // namespace axisgate::simulated
