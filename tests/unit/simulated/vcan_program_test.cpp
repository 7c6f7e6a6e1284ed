// axisgate-sim on a CAN interface: needs root and a kernel with vcan (tests/vcan/in_guest).
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>

#include "tests/simulated/socket_can_line.hpp"
#include "tests/unit/simulated/program_bench.hpp"

namespace axisgate::simulated {
namespace {

class VcanProgram : public ProgramBench {
 protected:
  void SetUp() override {
    ProgramBench::SetUp();
    (void)std::system("ip link del simtest0 2>/dev/null");
    ASSERT_EQ(std::system("ip link add simtest0 type vcan && ip link set simtest0 up"), 0);
    socket = Descriptor(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
    const can_err_mask_t errors = CAN_ERR_MASK;
    ASSERT_EQ(::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors), 0);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex("simtest0"));
    ASSERT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  void TearDown() override {
    ProgramBench::TearDown();
    (void)std::system("ip link del simtest0");
  }
  void send(const BusFrame& frame) {
    const auto bytes = socket_frame_of(frame);
    ASSERT_EQ(::write(socket.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  Bytes receive() {
    pollfd ready{socket.get(), POLLIN, 0};
    Bytes bytes(socket_frame_bytes);
    if (::poll(&ready, 1, 60000) <= 0 || ::read(socket.get(), bytes.data(), bytes.size()) <= 0) return {};
    return bytes;
  }
  static Bytes on_socket(const BusFrame& frame) {
    const auto bytes = socket_frame_of(frame);
    return {bytes.begin(), bytes.end()};
  }
  Descriptor socket;
};

TEST_F(VcanProgram, DrivesAnswerOnTheInterfaceAndBusOffIsAnErrorFrame) {
  start({"--line", "simtest0:can:ld2@1,jd@2", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  EXPECT_THAT(log(), testing::HasSubstr("ready simtest0 -> simtest0 can:ld2@1,jd@2"));
  send(bus_frame(cob::sdo_request + 1, from_hex("40 41 60 00 00 00 00 00")));
  EXPECT_EQ(receive(), on_socket(bus_frame(cob::sdo_reply + 1, from_hex("4B 41 60 00 50 02 00 00"))));
  send(bus_frame(cob::nmt, {0x82, 0}));
  EXPECT_EQ(receive(), on_socket(bus_frame(cob::error_control + 1, {0})));
  EXPECT_EQ(receive(), on_socket(bus_frame(cob::error_control + 2, {0})));
  EXPECT_EQ(control("bus-off simtest0 on"), "ok");
  EXPECT_EQ(receive(), from_hex("40 00 00 20 08 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(control("bus-off simtest0 off"), "ok");
  EXPECT_EQ(receive(), from_hex("00 01 00 20 08 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(control("unplug simtest0"), "ok");
  EXPECT_EQ(control("plug simtest0"), "ok");
  send(bus_remote_frame(cob::error_control + 2));
  EXPECT_EQ(receive(), on_socket(bus_frame(cob::error_control + 2, {0x7F})));
  EXPECT_EQ(end(SIGTERM), 0);
}

TEST_F(VcanProgram, AnInterfaceThatIsNotThereIsNamedWithTheRemedy) {
  start({"--line", "nothere0:can:ld2@1"});
  ASSERT_TRUE(wait_for_log("axisgate-sim: "));
  EXPECT_THAT(log(), testing::HasSubstr("ip link add dev nothere0 type vcan"));
}

}  // namespace
}  // namespace axisgate::simulated
