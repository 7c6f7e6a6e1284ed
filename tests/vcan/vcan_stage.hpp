// SPDX-License-Identifier: Apache-2.0
// A SocketCanLink on a vcan interface of its own, and a second socket on it as the rest of the bus.
// Needs root and a kernel with vcan: tests/vcan/in_guest.
#pragma once

#include <gmock/gmock.h>
#include <ifaddrs.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/if_link.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/can/link/socketcan_link.hpp"
#include "tests/unit/can/can_diary.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;

/// Everybody else on the bus.
class CanPeer {
 public:
  explicit CanPeer(const std::string& interface) : socket_(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    EXPECT_NE(address.can_ifindex, 0) << interface;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0) << std::strerror(errno);
  }
  CanPeer(const CanPeer&) = delete;
  CanPeer& operator=(const CanPeer&) = delete;
  ~CanPeer() { ::close(socket_); }

  void send(const can::CanFrame& frame) const {
    can_frame raw{};
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
    raw.can_dlc = frame.size;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
    write(raw);
  }
  /// As a controller's driver would.
  void send_error(canid_t classes, Byte controller = 0) const {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | classes;
    raw.can_dlc = CAN_ERR_DLC;
    raw.data[1] = controller;
    write(raw);
  }
  /// The frames that have arrived.
  [[nodiscard]] std::vector<can_frame> read() const {
    std::vector<can_frame> frames;
    can_frame raw{};
    while (::recv(socket_, &raw, sizeof raw, MSG_DONTWAIT) == static_cast<ssize_t>(sizeof raw)) frames.push_back(raw);
    return frames;
  }

 private:
  void write(const can_frame& raw) const {
    EXPECT_EQ(::write(socket_, &raw, sizeof raw), static_cast<ssize_t>(sizeof raw)) << std::strerror(errno);
  }
  int socket_;
};

class VcanStage : public testing::Test {
 protected:
  ~VcanStage() override {
    link.reset();
    if (interface.starts_with("vt")) (void)!std::system(("ip link del " + interface + " 2>/dev/null").c_str());
  }
  static void run(const std::string& command) { ASSERT_EQ(std::system(command.c_str()), 0) << command; }
  void add_interface() const { run("ip link add dev " + interface + " type vcan"); }
  void take_up() const { run("ip link set " + interface + " up"); }
  void take_down() const { run("ip link set " + interface + " down"); }
  void remove_interface() const { run("ip link del " + interface); }

  void start(std::vector<can::CanFilter> filters = kEverything) {
    link = std::make_unique<can::SocketCanLink>("lift", interface, 500000, context, runtime, log);
    link->start(diary, std::move(filters));
  }
  /// An interface that is up, the link on it, and a peer.
  void start_all(std::vector<can::CanFilter> filters = kEverything) {
    add_interface();
    take_up();
    start(std::move(filters));
    ASSERT_TRUE(await([this] { return diary.up(); }));
    peer = std::make_unique<CanPeer>(interface);
  }
  /// The guard is for a test that would else hang, and far beyond any real wait.
  template <typename Condition>
  [[nodiscard]] bool await(Condition condition) {
    const auto guard = std::chrono::steady_clock::now() + 60s;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > guard) return false;
      context.restart();
      context.run_one_for(100ms);
    }
    return true;
  }
  /// What the peer has heard so far, once it is `count` frames; the system may hand them over a little later.
  [[nodiscard]] bool await_heard(std::size_t count) {
    return await([&] {
      for (const can_frame& frame : peer->read()) heard.push_back(frame);
      return heard.size() >= count;
    });
  }
  /// Everything that the link has been told by now has come through once this frame has.
  void settle() {
    const std::size_t before = marks;
    peer->send(frame_of(kMark));
    ASSERT_TRUE(await([&] { return marks > before || !diary.up(); }));
  }

  /// Frames of this interface that no socket has seen: a processor queues 1,000 frames of all interfaces
  /// (net.core.netdev_max_backlog), and the system drops what comes while a busy machine has not handed those on.
  [[nodiscard]] std::uint32_t dropped_before_any_socket() const {
    ifaddrs* list = nullptr;
    EXPECT_EQ(::getifaddrs(&list), 0) << std::strerror(errno);
    const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
    for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
      if (interface != each->ifa_name || each->ifa_data == nullptr) continue;
      return static_cast<const rtnl_link_stats*>(each->ifa_data)->rx_dropped;
    }
    ADD_FAILURE() << "the system gives no statistics of " << interface;
    return 0;
  }

  static constexpr std::uint32_t kMark = 0x7E5;
  /// Names have 15 characters at most, and tests run beside one another.
  std::string interface = "vt" + std::to_string(::getpid());
  boost::asio::io_context context;
  AsioRuntime runtime{context};
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel level, std::string_view, std::string_view message) {
    log_lines.push_back(fmt::format("{}: {}", text(level), message));
  }};
  CanDiary diary;
  std::size_t marks = 0;
  std::unique_ptr<CanPeer> peer;
  std::vector<can_frame> heard;
  std::unique_ptr<can::SocketCanLink> link;

  void SetUp() override {
    diary.on_received = [this] {
      if (diary.frames.back().id != kMark) return;
      ++marks;
      diary.frames.pop_back();
      diary.instants.pop_back();
    };
  }
};

}  // namespace axisgate::test
