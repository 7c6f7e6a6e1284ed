// A simulated CAN bus behind an adapter: Lawicel's text, and the frames of a CAN socket.
#include <gmock/gmock.h>

#include "tests/simulated/lawicel_line.hpp"
#include "tests/simulated/socket_can_line.hpp"
#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

class Lawicel : public testing::Test {
 protected:
  explicit Lawicel(const LawicelOptions& adapter = {})
      : line(no_can_timing(), adapter, Random(1),
             [this](const ToHost& arrived) { heard.append(arrived.bytes.begin(), arrived.bytes.end()); }) {
    line.bus().add(a_leadshine(1));
  }
  std::string ask(const std::string& text) {
    heard.clear();
    line.from_host({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, now);
    return heard;
  }
  void open() { ASSERT_EQ(ask("S6\rO\r"), "\r\r"); }

  Time now{};
  std::string heard;
  LawicelLine line;
};

TEST_F(Lawicel, NothingPassesUntilTheChannelIsOpen) {
  EXPECT_EQ(ask("t60184041600000000000\r"), "\a");
  EXPECT_EQ(ask("O\r"), "\a");  // no rate yet
  EXPECT_EQ(ask("C\r"), "\a");
  line.bus().node(0).hear(bus_frame(cob::nmt, {0x82, 0}), 0, now);
  line.advance(now);
  EXPECT_EQ(heard, "\a");
  open();
  EXPECT_EQ(line.bus().bit_rate(), 500000U);
  EXPECT_EQ(ask("S4\r"), "\a");  // open
  EXPECT_EQ(ask("O\r"), "\a");
  EXPECT_EQ(ask("t60184041600000000000\r"), "z\r");
  EXPECT_EQ(ask("C\r"), "\r");
  EXPECT_EQ(ask("r7011\r"), "\a");
}

TEST_F(Lawicel, FramesAreTextBothWaysHoweverTheyAreSplit) {
  open();
  line.bus().set_bit_rate(0);
  const std::string request = "t60184041600000000000\r";
  for (std::size_t cut = 0; cut <= request.size(); ++cut) {
    const std::string first = ask(request.substr(0, cut));
    EXPECT_EQ(first + ask(request.substr(cut)), "t58184B41600050020000\rz\r") << cut;
  }
  EXPECT_EQ(ask("r7011\r"), "t70117F\rz\r");
}

TEST_F(Lawicel, WhatIsNoFrameIsRefused) {
  open();
  for (const char* wrong : {"t601\r", "t6019\r", "t60124041604\r", "t6012404\r", "t60Z0\r", "tF010 \r", "Q\r"}) {
    EXPECT_EQ(ask(wrong), "\a") << wrong;
  }
  EXPECT_EQ(ask(std::string(100, 't') + "\r"), "\a");
  EXPECT_EQ(ask("V\r"), "V1013\r");
  EXPECT_EQ(ask("\r"), "\r");
}

TEST_F(Lawicel, FlagsTellBusOffAndMissingAcknowledges) {
  open();
  EXPECT_EQ(ask("F\r"), "F00\r");
  line.set_bus_off(true, now);
  EXPECT_EQ(ask("F\r"), "FA0\r");
  line.set_bus_off(false, now);
  EXPECT_EQ(ask("F\r"), "FA0\r");  // until read
  EXPECT_EQ(ask("F\r"), "F00\r");
  line.miss_acknowledge(now);
  EXPECT_EQ(ask("F\r"), "FA4\r");
}

TEST_F(Lawicel, TimestampsFollowTheData) {
  EXPECT_EQ(ask("Z1\r"), "\r");
  open();
  line.bus().set_bit_rate(0);
  now = milliseconds(61234);
  EXPECT_EQ(ask("r7011\r"), "t70117F04D2\rz\r");
}

TEST_F(Lawicel, APulledCableTakesItsPower) {
  open();
  line.cut();
  EXPECT_FALSE(line.open());
  EXPECT_EQ(ask("O\r"), "\a");
}

class SilentLawicel : public Lawicel {
 protected:
  SilentLawicel() : Lawicel({.acknowledges = false, .has_flags = false}) {}
};

TEST_F(SilentLawicel, AnAdapterThatNeverAcknowledgesCarriesFramesAllTheSame) {
  EXPECT_EQ(ask("S6\rO\r"), "");
  line.bus().set_bit_rate(0);
  EXPECT_EQ(ask("F\r"), "");
  EXPECT_EQ(ask("t60184041600000000000\r"), "t58184B41600050020000\r");
}

TEST(SocketCan, FramesHaveTheLayoutOfTheKernelsHeader) {
  const auto bytes = socket_frame_of(bus_frame(0x581, {1, 2, 3}));
  EXPECT_EQ(Bytes(bytes.begin(), bytes.end()), from_hex("81 05 00 00 03 00 00 00 01 02 03 00 00 00 00 00"));
  EXPECT_EQ(frame_of_socket(bytes), bus_frame(0x581, {1, 2, 3}));
  const auto remote = socket_frame_of(bus_remote_frame(0x701));
  EXPECT_EQ(remote[3], 0x40);
  EXPECT_EQ(frame_of_socket(remote), bus_remote_frame(0x701));
  BusFrame extended = bus_frame(0x12345678, {9});
  extended.extended = true;
  EXPECT_EQ(frame_of_socket(socket_frame_of(extended)), extended);
  EXPECT_EQ(frame_of_socket(from_hex("40 00 00 20 08 00 00 00 00 00 00 00 00 00 00 00")), std::nullopt);
  EXPECT_EQ(frame_of_socket(from_hex("40")), std::nullopt);
}

TEST(SocketCan, BusOffIsToldByErrorFrames) {
  std::vector<Bytes> heard;
  SocketCanLine line(no_can_timing(), Random(1), [&heard](const ToHost& arrived) {
    heard.push_back({arrived.bytes.begin(), arrived.bytes.end()});
  });
  line.bus().add(a_leadshine(1));
  line.from_host(socket_frame_of(bus_remote_frame(0x701)), Time{});
  line.set_bus_off(true, Time{});
  line.from_host(socket_frame_of(bus_remote_frame(0x701)), Time{});
  line.set_bus_off(false, Time{});
  line.miss_acknowledge(Time{});
  EXPECT_THAT(heard, testing::ElementsAre(from_hex("01 07 00 00 01 00 00 00 7F 00 00 00 00 00 00 00"),
                                          from_hex("40 00 00 20 08 00 00 00 00 00 00 00 00 00 00 00"),
                                          from_hex("00 01 00 20 08 00 00 00 00 00 00 00 00 00 00 00"),
                                          from_hex("24 00 00 20 08 00 00 00 00 20 00 00 00 00 00 00")));
}

}  // namespace
}  // namespace axisgate::simulated
