// SPDX-License-Identifier: Apache-2.0
// Every SDO, NMT and heartbeat frame of the sheets of drives on CANopen against the simulated nodes, and every object
// of the Leadshine's. The PDOs are in scripts/canopen.txt and scripts/keya.txt.
#include <set>

#include "tests/unit/simulated/sheets.hpp"

namespace axisgate::simulated {
namespace {

struct NodeSheet {
  const char* name;
  const char* drive;
  int requests;
  int replies;
};

class CanSheet : public testing::TestWithParam<NodeSheet> {
 protected:
  // `zeros`: a Kinco acknowledges as the standard has it.
  LineSpec node(std::uint8_t number, bool zeros = false) const {
    LineSpec spec = spec_of(std::string("can:") + GetParam().drive + '@' + std::to_string(number));
    if (auto* kinco = std::get_if<KincoCanDrive>(&spec.can_drives[0])) {
      kinco->can.echoes_written = !zeros;
      kinco->can.first_word_needed = false;
    }
    return spec;
  }
  bool is_keya() const { return std::string(GetParam().drive).starts_with("keya"); }
};

// A PDO's objects can be written while it is off; the steps before have left it so.
void switch_pdo_off(Bench& bench, ObjectKey key, std::uint8_t id) {
  const auto write = [&](std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
    ASSERT_EQ(bench.sdo(sdo_request(0x23, {index, sub}, value), id).at(0), 0x60);
  };
  for (const int area : {0x1400, 0x1800}) {
    const auto at = static_cast<std::uint16_t>(area + (key.index & 0x1FF));
    const Bytes held = bench.sdo(sdo_request(0x40, {at, 1}), id);
    write(at, 1, little_endian(part(held, 4, 8)) | 0x80000000U);
  }
  if (key.index >= 0x1600 && key.sub == 0) {
    write(key.index, 1, 0x60400010);
    write(key.index, 2, 0x607A0020);
  }
}

TEST_P(CanSheet, every_request_is_understood_and_answered) {
  const int requests = each_vector(GetParam().name, "canopen-sdo", "request", [&](const nlohmann::json& vector) {
    const Bytes request = bytes_in(vector);
    const ObjectKey key{static_cast<std::uint16_t>(request[1] | request[2] << 8), request[3]};
    const std::uint8_t id = node_in(vector, cob::sdo_request);
    Bench bench(node(id));
    const bool of_pdo = key.index >= 0x1400 && key.index < 0x1C00 && key.sub <= 2;
    if (of_pdo && !is_keya()) switch_pdo_off(bench, key, id);
    const Bytes reply = bench.sdo(request, id);
    ASSERT_EQ(reply.size(), 8U);
    EXPECT_EQ(part(reply, 1, 4), part(request, 1, 4));
    const auto held = bench.bus().node(0).peek(key, bench.now);
    if (!held) {
      EXPECT_EQ(reply[0], 0x80);
    } else if (request[0] == 0x40) {
      EXPECT_TRUE(is_read_reply(reply[0]));
    } else {
      EXPECT_EQ(reply[0], 0x60);
      const bool command = key.index == 0x4000 || key.index == 0x3002 || (is_keya() && key.index >= 0x6000);
      EXPECT_TRUE(command || *held == part(request, 4, 4 + held->size()));
    }
    if (!is_keya()) return;
    EXPECT_TRUE(held.has_value());
    const std::string meaning = vector.at("decoded").value("meaning", "");
    EXPECT_EQ(bench.keya()->enabled(motor_a), meaning.starts_with("enable motor A"));
    EXPECT_EQ(bench.keya()->enabled(motor_b), meaning.starts_with("enable motor B"));
  });
  EXPECT_GE(requests, GetParam().requests);
}

// Brings a Keya to hold what only its motors can say; false: the object can be set.
bool move_keya(Bench& bench, ObjectKey key, std::uint8_t id) {
  if (key.index == 0x2011) {
    bench.keya()->inject_fault(motor_a, 0x0800);
  } else if (key.index == 0x2012) {  // 150 rpm: 10 % of rated
    bench.sdo(sdo_request(0x23, {0x607A, 0}, 0x030D2001), id);
    bench.sdo(sdo_request(0x23, {0x6081, 0}, 1000), id);
    bench.pass(milliseconds(900));
  } else {
    return false;
  }
  return true;
}

// A reply of the sheet comes out, byte for byte, when the drive holds what the reply tells.
TEST_P(CanSheet, every_reply_is_reproduced) {
  int replies = 0;
  each_vector(GetParam().name, "canopen-sdo", "response", [&](const nlohmann::json& vector) {
    const Bytes expected = bytes_in(vector);
    const ObjectKey key{static_cast<std::uint16_t>(expected[1] | expected[2] << 8), expected[3]};
    const std::uint8_t id = node_in(vector, cob::sdo_reply);
    Bench bench(node(id, expected[4] == 0 && expected[5] == 0));
    CanopenNode& there = bench.bus().node(0);
    const auto held = there.peek(key, bench.now);
    const std::uint32_t told = little_endian(part(expected, 4, 8));
    if (expected[0] == 0x80 && is_keya()) {
      bench.faults().abort_code = told;
      bench.faults().next(DriveFault::exception);
      EXPECT_EQ(bench.sdo(sdo_request(0x40, key), id), expected);
    } else if (expected[0] == 0x80) {
      const Bytes reply = bench.sdo(sdo_request(0x40, held ? ObjectKey{0x9999, 0} : key), id);
      ASSERT_EQ(reply.size(), 8U);
      EXPECT_EQ(reply[0], 0x80);
      EXPECT_EQ(part(reply, 4, 8), part(expected, 4, 8));
    } else if (expected[0] != 0x60) {
      const bool moves = is_keya() && move_keya(bench, key, id);
      const std::int64_t value = is_keya() ? told : value_in(vector.at("decoded"));
      if (!moves && there.poke(key, value, bench.now) != 0) return;  // measured: scripts
      EXPECT_EQ(bench.sdo(sdo_request(0x40, key), id), expected);
    } else {
      ASSERT_TRUE(held.has_value());
      // Any value that the object takes: the acknowledgement is the same but for an echo.
      Bytes reply{0x80};
      for (const std::uint32_t value : {told, 1U, 0x5A5AU, little_endian(*held)}) {
        if (reply.at(0) == 0x80) reply = bench.sdo(sdo_request(sdo_write(held->size()), key, value), id);
      }
      if (reply[0] == 0x80) return;  // a mapping, of a PDO that is on: see the requests
      EXPECT_EQ(reply, expected);
    }
    ++replies;
  });
  EXPECT_GE(replies, GetParam().replies);
}

TEST_P(CanSheet, nmt_commands_heartbeats_and_guarding_are_those_of_the_sheet) {
  const std::map<int, NmtState> leads_to{{0x01, NmtState::operational},
                                         {0x02, NmtState::stopped},
                                         {0x80, NmtState::pre_operational},
                                         {0x81, NmtState::initialising},
                                         {0x82, NmtState::pre_operational}};
  int checked = each_vector(GetParam().name, "canopen-nmt", "request", [&](const nlohmann::json& vector) {
    const Bytes command = bytes_in(vector);
    const std::uint8_t id = command.at(1) == 0 ? std::uint8_t{3} : command[1];
    Bench bench(node(id));
    bench.send(bus_frame(cob::nmt, {1, id}));
    bench.send(bus_frame(cob::nmt, command));
    EXPECT_EQ(bench.bus().node(0).state(), leads_to.at(command[0]));
  });
  const std::map<int, std::uint8_t> command_to{{0, 0x82}, {5, 0x01}, {4, 0x02}, {0x7F, 0x80}};
  checked += each_vector(GetParam().name, "canopen-heartbeat", "response", [&](const nlohmann::json& vector) {
    const std::uint8_t id = node_in(vector, cob::error_control);
    const Bytes expected = bytes_in(vector);
    Bench bench(node(id));
    bench.sdo(sdo_request(is_keya() ? 0x23 : 0x2B, {0x1017, 0}, 100), id);
    bench.send(bus_frame(cob::nmt, {command_to.at(expected.at(0)), id}));
    bench.pass(milliseconds(expected[0] == 0 ? 0 : 100));
    EXPECT_EQ(bench.heard(cob::error_control + id), expected);
  });
  checked += each_vector(GetParam().name, "canopen-guard", "response", [&](const nlohmann::json& vector) {
    const Bytes expected = bytes_in(vector);
    Bench bench(node(1));
    bench.send(bus_frame(cob::nmt, {static_cast<std::uint8_t>((expected[0] & 0x7F) == 5 ? 0x01 : 0x80), 1}));
    for (int i = vector.at("decoded").at("toggle").get<int>(); i >= 0; --i) {
      bench.send(bus_remote_frame(cob::error_control + 1));
    }
    EXPECT_EQ(bench.heard(cob::error_control + 1), expected);
  });
  EXPECT_GE(checked, 4);
}

INSTANTIATE_TEST_SUITE_P(sheets, CanSheet,
                         testing::Values(NodeSheet{"leadshine-ld2-can", "ld2", 70, 25},
                                         NodeSheet{"kinco-jd", "jd", 24, 17}, NodeSheet{"kinco-md", "md", 16, 15},
                                         NodeSheet{"keya-kydas4860-2e", "keya-kydas4860-2e", 30, 18}),
                         [](const auto& sheet) { return std::string(sheet.param.drive).substr(0, 4); });

TEST(leadshine_sheet, every_object_is_there) {
  Bench bench("can:ld2");
  int objects = 0;
  for (const auto& row : sheet_of("leadshine-ld2-can", "objects")) {
    const ObjectKey key = key_in(row);
    // Named only, and not needed by anybody: cycle, window, TIME, inhibit times.
    if (std::set<int>{0x1006, 0x1007, 0x1012, 0x1013, 0x1015}.contains(key.index)) continue;
    SCOPED_TRACE(row.dump());
    const auto found = bench.bus().node(0).peek(key, bench.now);
    ASSERT_TRUE(found.has_value());
    ++objects;
    const bool sized = !row.at("bits").is_null() && key.index >= 0x2000;
    EXPECT_TRUE(!sized || 8 * found->size() == row.at("bits").get<std::size_t>());
  }
  EXPECT_GE(objects, 290);
}

}  // namespace
}  // namespace axisgate::simulated
