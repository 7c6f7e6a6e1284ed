// A Kinco on its RS485 port: registers, functions, error replies (JD 2.2, JD 3, MD 3).
#include <gmock/gmock.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

struct Sheet {
  KincoType type;
  const char* name;
};

class KincoRtuSheet : public testing::TestWithParam<Sheet> {};

// Requests are answered as the sheet says; replies come out, byte for byte, when the drive holds what they tell.
TEST_P(KincoRtuSheet, EveryFrameIsAnsweredAndEveryBadOneMeetsSilence) {
  int requests = 0;
  const auto rows = sheet_of(GetParam().name, "vectors");
  for (const auto& vector : rows) {
    if (vector.at("protocol") != "modbus-rtu" || vector.at("direction") != "request") continue;
    SCOPED_TRACE(vector.at("id").get<std::string>());
    RtuBench bench(an_rtu_kinco(GetParam().type));
    const Bytes request = from_hex(vector.at("hex").get<std::string>());
    const Bytes reply = bench.exchange(request);
    ++requests;
    if (!vector.at("checksum_ok").get<bool>()) {
      EXPECT_TRUE(reply.empty());
      continue;
    }
    const auto frame = open_rtu(reply);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->unit, 1);
    ASSERT_EQ(frame->pdu[0], request[1]);
    if (request[1] == 0x03) {
      EXPECT_EQ(frame->pdu[1], 2 * request[5]);
    } else {
      EXPECT_EQ(Bytes(reply.begin(), reply.begin() + 6), Bytes(request.begin(), request.begin() + 6));
    }
  }
  EXPECT_GE(requests, 25);
}

TEST_P(KincoRtuSheet, EveryRegisterOfTheSheetReachesItsObjectAndNoOtherExists) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  std::map<std::uint16_t, int> registers;  // and how many words
  const auto rows = sheet_of(GetParam().name, "objects");
  for (const auto& row : rows) {
    if (row.at("modbus").is_null()) continue;
    const auto number = static_cast<std::uint16_t>(std::stoul(row.at("modbus").get<std::string>(), nullptr, 16));
    const ObjectKey key{static_cast<std::uint16_t>(std::stoul(row.at("index").get<std::string>(), nullptr, 16)),
                        row.at("sub").get<std::uint8_t>()};
    SCOPED_TRACE(row.dump());
    const ObjectEntry* entry = bench.kinco().entry(key);
    ASSERT_NE(entry, nullptr);
    registers[number] = bytes_of(entry->type) == 4 ? 2 : 1;
    const auto words = bench.read(number, static_cast<std::uint16_t>(registers[number]));
    ASSERT_EQ(words.size(), static_cast<std::size_t>(registers[number]));
    const auto value = static_cast<std::uint32_t>(*bench.kinco().peek(key));
    EXPECT_EQ(words[0], value & 0xFFFF);
    EXPECT_EQ(words.back(), words.size() == 2 ? value >> 16 : value & 0xFFFF);
    const bool derived = row.at("modbus_origin") == "derived";
    KincoRtuDrive strict = an_rtu_kinco(GetParam().type);
    strict.rtu.serves_derived = false;
    EXPECT_EQ(RtuBench(strict).read(number, static_cast<std::uint16_t>(registers[number])).empty(), derived);
  }
  EXPECT_GE(registers.size(), 101U);
  int answered = 0;
  for (std::uint32_t number = 0; number < 0x10000; number += 0x10) {
    const auto at = static_cast<std::uint16_t>(number);
    const bool one = bench.ask(read_pdu(at, 1))->at(0) == 0x03;
    const bool two = bench.ask(read_pdu(at, 2))->at(0) == 0x03;
    answered += one || two ? 1 : 0;
    EXPECT_EQ(one || two, registers.contains(at)) << number;
  }
  EXPECT_EQ(answered, static_cast<int>(registers.size()));
}

TEST_P(KincoRtuSheet, AReadOfWhatIsNotThereIsRefusedWith81AsPrinted) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  EXPECT_EQ(bench.exchange(seal_rtu(1, read_pdu(0x3600, 1))), from_hex("01 81 02 C1 91"));  // 6061 has no address
  KincoRtuDrive standard = an_rtu_kinco(GetParam().type);
  standard.rtu.read_error_function = 0x83;
  RtuBench other(standard);
  EXPECT_EQ(other.exchange(seal_rtu(1, read_pdu(0x3600, 1))), from_hex("01 83 02 C0 F1"));
}

TEST_P(KincoRtuSheet, WritesAreRefusedWith86And90) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  EXPECT_EQ(bench.exchange(seal_rtu(1, write_pdu(0x3600, 1))), from_hex("01 86 02 C3 A1"));
  EXPECT_EQ(bench.exchange(seal_rtu(1, write_long_pdu(0x3601, 1))), from_hex("01 90 02 CD C1"));
  EXPECT_EQ(bench.write(0x3200, 1), 2);            // the status word is read-only
  EXPECT_EQ(bench.write(0x3500, 2), 3);            // no mode 2
  EXPECT_EQ(bench.write(0x6F00, 1), 3);            // half of a 32-bit object
  EXPECT_EQ(bench.write(0x6F01, 1), 2);            // its upper half has no register of its own
  EXPECT_EQ(bench.write_pair(0x3100, 0x0F), 3);    // two words for a 16-bit object
  EXPECT_EQ(bench.write_several(0x3100, {6}), 0);  // function 16 with one
  EXPECT_EQ(bench.kinco().writes({0x6040, 0}), 1U);
}

TEST_P(KincoRtuSheet, ReadsTakeOneObjectAtATime) {
  KincoRtuDrive options = an_rtu_kinco(GetParam().type);
  options.rtu.second_register = 0xABCD;
  RtuBench bench(options);
  EXPECT_EQ(bench.read(0x3200, 1).size(), 1U);
  EXPECT_THAT(bench.read(0x3200, 2), testing::ElementsAre(bench.word(0x3200), 0xABCD));  // printed, contents unknown
  EXPECT_EQ(RtuBench::code_of(bench.ask(read_pdu(0x3200, 3))), 3);
  EXPECT_EQ(RtuBench::code_of(bench.ask(read_pdu(0x3200, 0))), 3);
  EXPECT_EQ(RtuBench::code_of(bench.ask(read_pdu(0x3700, 1))), 3);  // half of the position
  EXPECT_EQ(RtuBench::code_of(bench.ask(read_pdu(0x3701, 1))), 2);
}

TEST_P(KincoRtuSheet, OtherFunctionsAreUnknownAndWrongLengthsRefused) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  for (const int asked : {0x01, 0x02, 0x04, 0x05, 0x08, 0x0F, 0x17, 0x2B}) {
    const auto reply = bench.ask({static_cast<std::uint8_t>(asked), 0x32, 0x00, 0x00, 0x01});
    EXPECT_EQ(*reply, (Bytes{static_cast<std::uint8_t>(asked | 0x80), 1}));
  }
  EXPECT_EQ(RtuBench::code_of(bench.ask({0x03, 0x32, 0x00, 0x00})), 3);
  EXPECT_EQ(RtuBench::code_of(bench.ask({0x10, 0x6F, 0x00, 0x00, 0x02, 0x02, 0x00, 0x00})), 3);
}

TEST_P(KincoRtuSheet, LowWordFirst) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  bench.exchange(from_hex("01 10 40 00 00 02 04 3C B0 FF FF CE 6B"));
  EXPECT_EQ(bench.kinco().peek({0x607A, 0}), -50000);
  EXPECT_EQ(bench.exchange(seal_rtu(1, read_pdu(0x4000, 2))), from_hex("01 03 04 3C B0 FF FF F6 34"));
}

TEST_P(KincoRtuSheet, ANegativeModeIsTakenFromTheLowByteAndReadsAsChosen) {
  for (const bool sign_extends : {true, false}) {
    KincoRtuDrive options = an_rtu_kinco(GetParam().type);
    options.rtu.sign_extends_bytes = sign_extends;
    RtuBench bench(options);
    for (const int raw : {0xFFFD, 0x00FD}) {
      EXPECT_EQ(bench.write(0x3500, raw), 0);
      EXPECT_EQ(bench.kinco().peek({0x6060, 0}), -3);
      EXPECT_EQ(bench.word(0x3500), sign_extends ? 0xFFFD : 0x00FD);
      bench.write(0x3500, 1);
    }
  }
}

TEST_P(KincoRtuSheet, ABroadcastIsObeyedByAllAndAnsweredByNobody) {
  RtuBench bench(std::vector<RtuDriveOptions>{an_rtu_kinco(GetParam().type, 1), an_rtu_kinco(GetParam().type, 2)});
  EXPECT_TRUE(bench.exchange(seal_rtu(0, write_pdu(0x3100, 0x0F))).empty());
  EXPECT_EQ(bench.kinco(0).state(), Cia402State::operation_enabled);
  EXPECT_EQ(bench.kinco(1).state(), Cia402State::operation_enabled);
  EXPECT_EQ(bench.word(0x3200, 2) & 0x6F, 0x27);
}

// Appendix 2 of the JD, 10.5 of the MD: position, in words of the manual.
TEST_P(KincoRtuSheet, MovesByThePrintedFrames) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  for (const char* frame :
       {"01 06 31 00 00 0F C7 32", "01 06 35 00 00 01 47 C6", "01 10 40 00 00 02 04 C3 50 00 00 FE 39",
        "01 10 4A 00 00 02 04 55 55 00 08 BC D6", "01 06 31 00 00 2F C6 EA", "01 06 31 00 00 3F C7 26"}) {
    EXPECT_EQ(bench.exchange(from_hex(frame)).size(), 8U) << frame;
  }
  EXPECT_TRUE(bench.pass_until([&] { return (bench.word(0x3200) & 0x0400) != 0 && bench.pair(0x3700) == 50000; }));
  EXPECT_EQ(bench.kinco().transitions().back().to, Cia402State::operation_enabled);
}

TEST_P(KincoRtuSheet, FaultsAndTheirResetAreTheSameDrives) {
  RtuBench bench(an_rtu_kinco(GetParam().type));
  bench.write(0x3100, 0x0F);
  bench.kinco().inject_fault(1, 0x0020);
  EXPECT_TRUE(bench.pass_until([&] { return (bench.word(0x3200) & 0x4F) == 0x08; }));
  EXPECT_EQ(bench.word(0x1F00), 0x0020);
  bench.kinco().clear_fault_cause(1, 0x0020);
  EXPECT_EQ(bench.exchange(from_hex("01 06 31 00 00 86 06 94")).size(), 8U);
  EXPECT_EQ(bench.word(0x1F00), 0);
}

INSTANTIATE_TEST_SUITE_P(Kinco, KincoRtuSheet,
                         testing::Values(Sheet{KincoType::jd, "kinco-jd"}, Sheet{KincoType::md, "kinco-md"}),
                         [](const auto& sheet) { return sheet.param.type == KincoType::jd ? "jd" : "md"; });

TEST(KincoRtu, TheJdRefusesOrClampsWhatIsOutOfRange) {
  RtuBench bench(an_rtu_kinco(KincoType::jd));
  EXPECT_EQ(bench.write_pair(0x6F00, 20000000), 3);
  KincoRtuDrive options = an_rtu_kinco(KincoType::jd);
  options.rtu.refuses_out_of_range = false;
  RtuBench clamping(options);
  EXPECT_EQ(clamping.write_pair(0x6F00, 20000000), 0);
  EXPECT_EQ(clamping.pair(0x6F00), 16777215);
}

TEST(KincoRtu, AnMdSetBackToItsDefaultsIsMuteOnModbus) {
  RtuBench bench(an_rtu_kinco(KincoType::md));
  EXPECT_EQ(bench.write(0x2910, 10), 0);
  EXPECT_EQ(bench.write(0x2910, 1), 0);
  bench.pass(milliseconds(100));
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
  EXPECT_TRUE(bench.exchange(seal_rtu(1, read_pdu(0x3200, 1))).empty());  // 6510:0C = 1 again
}

TEST(KincoRtu, ABootingDriveIsSilent) {
  RtuBench bench(an_rtu_kinco(KincoType::jd));
  bench.line().restart(0, bench.now);
  EXPECT_TRUE(bench.exchange(seal_rtu(1, read_pdu(0x3200, 1))).empty());
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.word(0x3200), 0x4050);
}

}  // namespace
}  // namespace axisgate::simulated
