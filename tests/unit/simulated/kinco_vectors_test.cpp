// Every frame, object, register and conversion of the two Kinco sheets and the Leadshine's against the simulated
// drives, read from tests/vectors.
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

Bytes part(const Bytes& bytes, std::size_t from, std::size_t to) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.begin() + static_cast<std::ptrdiff_t>(to)};
}

std::int64_t value_in(const nlohmann::json& decoded) {
  return decoded.value("value_signed", decoded.value("value", std::int64_t{0}));
}

struct Sheet {
  const char* name;
  KincoType type;
  int sdo_requests;
  int sdo_replies;
};

class KincoSheet : public testing::TestWithParam<Sheet> {
 protected:
  KincoType type() const { return GetParam().type; }
  nlohmann::json rows(const char* of) const { return sheet_of(GetParam().name, of); }
};

TEST_P(KincoSheet, every_request_of_the_serial_protocol_is_answered_and_every_bad_one_meets_silence) {
  int requests = 0;
  each_vector(GetParam().name, "kinco-rs232", "request", [&](const nlohmann::json& vector) {
    KincoBench bench({a_drive(type())});
    const Bytes request = from_hex(vector.at("hex").get<std::string>());
    const Bytes reply = bench.exchange(request);
    ++requests;
    ASSERT_EQ(reply.size(), vector.at("checksum_ok").get<bool>() ? frame_length : 0U);
    if (reply.empty()) return;
    const auto& decoded = vector.at("decoded");
    if (!bench.line.drive(0).peek(key_in(decoded))) {  // 6510.0C is the MD's alone
      EXPECT_EQ(reply[1], 0x80);
      return;
    }
    EXPECT_EQ(reply[0], decoded.at("station").get<int>());
    EXPECT_EQ(part(reply, 2, 5), part(request, 2, 5));
    const bool reads = decoded.at("op") == "read";
    EXPECT_THAT(reply[1], reads ? testing::AnyOf(0x43, 0x4B, 0x4F) : testing::AnyOf(0x60, 0x60, 0x60));
    EXPECT_TRUE(reads || part(reply, 5, 9) == part(request, 5, 9));
  });
  EXPECT_GE(requests, type() == KincoType::jd ? 31 : 30);
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(KincoSheet, every_reply_of_the_serial_protocol_is_reproduced) {
  int replies = 0;
  each_vector(GetParam().name, "kinco-rs232", "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    if (!decoded.contains("index")) return;  // the cascade stream: see kinco_test
    const ObjectKey key = key_in(decoded);
    if (key.index == 0x6041 || key.index == 0x6063) return;  // measured: see kinco_test
    const Bytes expected = from_hex(vector.at("hex").get<std::string>());
    DriveOptions options = a_drive(type());
    options.echo_written_value = expected[5] != 0 || expected[6] != 0;
    KincoBench bench({options});
    KincoDrive& drive = bench.line.drive(0);
    ++replies;
    if (decoded.at("op") == "error") {
      const Bytes reply = bench.exchange(ten_bytes(FrameCommand::read, drive.peek(key) ? ObjectKey{0x9999, 0} : key));
      ASSERT_EQ(reply.size(), frame_length);
      EXPECT_EQ(reply[1], 0x80);
      EXPECT_EQ(part(reply, 5, 9), part(expected, 5, 9));
    } else if (decoded.at("op") == "read-ok") {
      ASSERT_EQ(drive.poke(key, value_in(decoded)), Refusal::none);
      EXPECT_EQ(bench.exchange(ten_bytes(FrameCommand::read, key)), expected);
    } else {
      const auto command = key.index == 0x607A ? FrameCommand::write_4 : FrameCommand::write_2;
      const auto written = static_cast<std::uint32_t>(options.echo_written_value ? value_in(decoded) : 0x2F);
      EXPECT_EQ(bench.exchange(ten_bytes(command, key, written)), expected);
    }
  });
  EXPECT_GE(replies, 4);
}

TEST_P(KincoSheet, every_object_has_its_width_and_access) {
  KincoBench bench({a_drive(type())});
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
    double amount = 0;
    int counts = 0;
    const auto reads = [&](const char* unit) {
      return std::sscanf(text.c_str(), (std::string("%lf ") + unit + ", enc %d").c_str(), &amount, &counts) == 2 ||
             std::sscanf(text.c_str(), (std::string("%lf ") + unit + ", resolution %d").c_str(), &amount, &counts) == 2;
    };
    const bool speed = row.at("quantity") == "speed" && reads("rpm");
    const bool acceleration = row.at("quantity") == "acceleration" && reads("rps/s") && amount == std::trunc(amount);
    if (!speed && !acceleration) continue;
    const auto whole = static_cast<std::int64_t>(amount);
    EXPECT_EQ(speed ? speed_dec(whole, counts) : acceleration_dec(whole, counts),
              std::llround(row.at("exact").get<double>()))
        << text;
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

TEST_P(KincoSheet, every_frame_of_modbus_is_answered_and_every_bad_one_meets_silence) {
  int requests = 0;
  each_vector(GetParam().name, "modbus-rtu", "request", [&](const nlohmann::json& vector) {
    RtuBench bench({an_rtu_kinco(type())});
    const Bytes request = from_hex(vector.at("hex").get<std::string>());
    const Bytes reply = bench.exchange(request);
    ++requests;
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
  RtuBench bench({an_rtu_kinco(type())});
  const auto ask = [](RtuBench& whom, std::uint16_t at, int words) {
    const auto frame = open_rtu(whom.exchange(seal_rtu(1, read_pdu(at, static_cast<std::uint16_t>(words)))));
    return frame && frame->pdu[0] == function::read ? part(frame->pdu, 2, frame->pdu.size()) : Bytes{};
  };
  KincoRtuDrive strict = an_rtu_kinco(type());
  strict.rtu.serves_derived = false;
  std::map<std::uint16_t, int> registers;  // and how many words
  for (const auto& row : rows("objects")) {
    if (row.at("modbus").is_null()) continue;
    SCOPED_TRACE(row.dump());
    const auto number = static_cast<std::uint16_t>(hex_number(row.at("modbus")));
    KincoDrive& drive = *bench.line.kinco(0);
    const ObjectEntry* entry = drive.entry(key_in(row));
    ASSERT_NE(entry, nullptr);
    const int words = registers[number] = bytes_of(entry->type) == 4 ? 2 : 1;
    const auto value = static_cast<std::uint32_t>(*drive.peek(key_in(row)));
    RtuBytes expected;
    append_word(expected, static_cast<std::uint16_t>(value));
    if (words == 2) append_word(expected, static_cast<std::uint16_t>(value >> 16));
    EXPECT_EQ(ask(bench, number, words), expected);
    RtuBench printed({strict});
    EXPECT_EQ(ask(printed, number, words).empty(), row.at("modbus_origin") == "derived");
  }
  EXPECT_GE(registers.size(), 101U);
  for (std::uint32_t number = 0; number < 0x10000; number += 0x10) {
    const auto at = static_cast<std::uint16_t>(number);
    EXPECT_EQ(!ask(bench, at, 1).empty() || !ask(bench, at, 2).empty(), registers.contains(at)) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(sheets, KincoSheet,
                         testing::Values(Sheet{"kinco-jd", KincoType::jd, 0, 0},
                                         Sheet{"kinco-md", KincoType::md, 0, 0}),
                         [](const auto& sheet) { return sheet.param.type == KincoType::jd ? "jd" : "md"; });

class CanSheet : public testing::TestWithParam<Sheet> {
 protected:
  CanDriveOptions drive(std::uint8_t node, bool zeros = false) const {
    if (std::string(GetParam().name) == "leadshine-ld2-can") return a_leadshine(node);
    KincoCanDrive made = a_can_kinco(GetParam().type, node);
    made.can.echoes_written = !zeros;
    made.can.first_word_needed = false;
    return made;
  }
  static std::uint8_t node_in(const nlohmann::json& vector, std::uint32_t base) {
    return static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - base);
  }
  static Bytes bytes_in(const nlohmann::json& vector) {
    return from_hex(vector.value("hex_padded", vector.at("hex").get<std::string>()));
  }
};

TEST_P(CanSheet, every_request_is_understood_and_answered) {
  int requests = 0;
  each_vector(GetParam().name, "canopen-sdo", "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const ObjectKey key = key_in(decoded);
    const std::uint8_t id = node_in(vector, cob::sdo_request);
    CanBench bench({drive(id)});
    const auto write = [&](std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
      ASSERT_EQ(bench.sdo(sdo_request(0x23, {index, sub}, value), id).at(0), 0x60);
    };
    if (key.index >= 0x1400 && key.index < 0x1C00 && key.sub <= 2) {
      for (const int area : {0x1400, 0x1800}) {  // as the steps before have left it: off
        const auto at = static_cast<std::uint16_t>(area + (key.index & 0x1FF));
        const Bytes held = bench.sdo(sdo_request(0x40, {at, 1}), id);
        write(at, 1, little_endian(part(held, 4, 8)) | 0x80000000U);
      }
      if (key.index >= 0x1600 && key.sub == 0) {
        write(key.index, 1, 0x60400010);
        write(key.index, 2, 0x607A0020);
      }
    }
    const Bytes request = bytes_in(vector);
    const Bytes reply = bench.sdo(request, id);
    ++requests;
    ASSERT_EQ(reply.size(), 8U);
    EXPECT_EQ(part(reply, 1, 4), part(request, 1, 4));
    const auto held = bench.line.node(0).peek(key, bench.now);
    if (!held) {
      EXPECT_EQ(reply[0], 0x80);
    } else if (decoded.at("op") == "read") {
      EXPECT_THAT(reply[0], testing::AnyOf(0x43, 0x4B, 0x4F));
    } else {
      EXPECT_EQ(reply[0], 0x60);
      if (key.index == 0x4000 || key.index == 0x3002) return;  // commands
      EXPECT_EQ(*held, part(request, 4, 4 + decoded.at("size").get<std::size_t>()));
    }
  });
  EXPECT_GE(requests, GetParam().sdo_requests);
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(CanSheet, every_reply_is_reproduced) {
  int replies = 0;
  each_vector(GetParam().name, "canopen-sdo", "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const ObjectKey key = key_in(decoded);
    const std::uint8_t id = node_in(vector, cob::sdo_reply);
    const Bytes expected = bytes_in(vector);
    CanBench bench({drive(id, expected[4] == 0 && expected[5] == 0)});
    const auto held = bench.line.node(0).peek(key, bench.now);
    if (decoded.at("op") == "error") {
      const Bytes reply = bench.sdo(sdo_request(0x40, held ? ObjectKey{0x9999, 0} : key), id);
      ASSERT_EQ(reply.size(), 8U);
      EXPECT_EQ(reply[0], 0x80);
      EXPECT_EQ(part(reply, 4, 8), part(expected, 4, 8));
    } else if (decoded.at("op") == "read-ok") {
      if (bench.line.node(0).poke(key, value_in(decoded), bench.now) != 0)
        return;  // measured: see can_test, kinco_test
      EXPECT_EQ(bench.sdo(sdo_request(0x40, key), id), expected);
    } else {
      ASSERT_TRUE(held.has_value());
      // Any value that the object takes: the acknowledgement is the same but for an echo.
      Bytes reply{0x80};
      for (const std::uint32_t value : {little_endian(part(expected, 4, 8)), 1U, 0x5A5AU, little_endian(*held)}) {
        if (reply.at(0) == 0x80) reply = bench.sdo(sdo_request(sdo_write(held->size()), key, value), id);
      }
      if (reply[0] == 0x80) return;  // a mapping, of a PDO that is on: see the requests
      EXPECT_EQ(reply, expected);
    }
    ++replies;
  });
  EXPECT_GE(replies, GetParam().sdo_replies);
}

TEST_P(CanSheet, nmt_commands_heartbeats_and_guarding_are_those_of_the_sheet) {
  int checked = 0;
  const std::map<int, NmtState> leads_to{{0x01, NmtState::operational},
                                         {0x02, NmtState::stopped},
                                         {0x80, NmtState::pre_operational},
                                         {0x81, NmtState::initialising},
                                         {0x82, NmtState::pre_operational}};
  each_vector(GetParam().name, "canopen-nmt", "request", [&](const nlohmann::json& vector) {
    const Bytes command = bytes_in(vector);
    const std::uint8_t id = command.at(1) == 0 ? std::uint8_t{3} : command[1];
    CanBench bench({drive(id)});
    bench.send(bus_frame(cob::nmt, {1, id}));
    bench.send(bus_frame(cob::nmt, command));
    EXPECT_EQ(bench.line.node(0).state(), leads_to.at(command[0]));
    ++checked;
  });
  const std::map<int, std::uint8_t> command_to{{0, 0x82}, {5, 0x01}, {4, 0x02}, {0x7F, 0x80}};
  each_vector(GetParam().name, "canopen-heartbeat", "response", [&](const nlohmann::json& vector) {
    const std::uint8_t id = node_in(vector, cob::error_control);
    const Bytes expected = bytes_in(vector);
    CanBench bench({drive(id)});
    bench.sdo(sdo_request(0x2B, {0x1017, 0}, 100), id);
    bench.send(bus_frame(cob::nmt, {command_to.at(expected.at(0)), id}));
    bench.pass(milliseconds(expected[0] == 0 ? 0 : 100));
    EXPECT_EQ(bench.heard(cob::error_control + id), expected);
    ++checked;
  });
  each_vector(GetParam().name, "canopen-guard", "response", [&](const nlohmann::json& vector) {
    const Bytes expected = bytes_in(vector);
    CanBench bench({drive(1)});
    bench.send(bus_frame(cob::nmt, {static_cast<std::uint8_t>((expected[0] & 0x7F) == 5 ? 0x01 : 0x80), 1}));
    for (int i = vector.at("decoded").at("toggle").get<int>(); i >= 0; --i) {
      bench.send(bus_remote_frame(cob::error_control + 1));
    }
    EXPECT_EQ(bench.heard(cob::error_control + 1), expected);
    ++checked;
  });
  EXPECT_GE(checked, 4);
}

INSTANTIATE_TEST_SUITE_P(sheets, CanSheet,
                         testing::Values(Sheet{"leadshine-ld2-can", KincoType::jd, 70, 25},
                                         Sheet{"kinco-jd", KincoType::jd, 24, 17},
                                         Sheet{"kinco-md", KincoType::md, 16, 15}),
                         [](const auto& sheet) {
                           const std::string name = sheet.param.name;
                           return name.starts_with("kinco-") ? name.substr(6) : "ld2";
                         });

TEST(leadshine_sheet, every_object_is_there) {
  CanBench bench({a_leadshine()});
  int objects = 0;
  for (const auto& row : sheet_of("leadshine-ld2-can", "objects")) {
    const ObjectKey key = key_in(row);
    // Named only, and not needed by anybody: cycle, window, TIME, inhibit times.
    if (std::set<int>{0x1006, 0x1007, 0x1012, 0x1013, 0x1015}.contains(key.index)) continue;
    SCOPED_TRACE(row.dump());
    const auto found = bench.line.node(0).peek(key, bench.now);
    ASSERT_TRUE(found.has_value());
    ++objects;
    EXPECT_TRUE(row.at("bits").is_null() || key.index < 0x2000 ||
                8 * found->size() == row.at("bits").get<std::size_t>());
  }
  EXPECT_GE(objects, 290);
}

}  // namespace
}  // namespace axisgate::simulated
