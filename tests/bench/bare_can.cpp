#include "tests/bench/bare_can.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Sdo = std::array<std::uint8_t, 8>;

constexpr std::uint32_t kRequest = 0x601, kReply = 0x581;
constexpr std::array<Sdo, 2> kWrites{
    {{0x23, 0x81, 0x60, 0, 0xA0, 0x86, 0x01, 0}, {0x23, 0x81, 0x60, 0, 0x40, 0x0D, 0x03, 0}}};
constexpr Sdo kRead{0x40, 0x41, 0x60, 0, 0, 0, 0, 0};
/// A gateway that was ended in the middle of an exchange leaves a reply behind that comes later.
constexpr std::chrono::milliseconds kLastReply{50};

[[noreturn]] void fail(const std::string& device) { throw std::runtime_error(device + ": " + std::strerror(errno)); }

class BareCan {
 public:
  explicit BareCan(int port) : port_(port) {}
  virtual ~BareCan() { ::close(port_); }
  BareCan(const BareCan&) = delete;
  BareCan& operator=(const BareCan&) = delete;
  virtual void exchange(const Sdo& request) = 0;

 protected:
  void write(const void* bytes, std::size_t size) const {
    if (::write(port_, bytes, size) != static_cast<ssize_t>(size)) throw std::runtime_error("the port takes no bytes");
  }
  std::size_t read(void* bytes, std::size_t size) const {
    pollfd ready{port_, POLLIN, 0};
    if (::poll(&ready, 1, 1000) <= 0) throw std::runtime_error("no reply for 1 s");
    const ssize_t got = ::read(port_, bytes, size);
    if (got <= 0) throw std::runtime_error("the port hung up");
    return static_cast<std::size_t>(got);
  }
  int port_;
};

class BareSocket final : public BareCan {
 public:
  explicit BareSocket(const std::string& interface) : BareCan(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    const can_filter filter{kReply, CAN_SFF_MASK};
    if (port_ < 0 || ::setsockopt(port_, SOL_CAN_RAW, CAN_RAW_FILTER, &filter, sizeof filter) != 0 ||
        ::bind(port_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      fail(interface);
    std::this_thread::sleep_for(kLastReply);
    can_frame old{};
    while (::recv(port_, &old, sizeof old, MSG_DONTWAIT) > 0) continue;
  }
  void exchange(const Sdo& request) override {
    can_frame frame{};
    frame.can_id = kRequest;
    frame.can_dlc = static_cast<std::uint8_t>(request.size());
    std::copy(request.begin(), request.end(), std::begin(frame.data));
    write(&frame, sizeof frame);
    read(&frame, sizeof frame);
  }
};

class BareLawicel final : public BareCan {
 public:
  explicit BareLawicel(const std::string& device) : BareCan(::open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (port_ < 0) fail(device);
    constexpr std::string_view kOpen = "\rC\rS6\rO\r";
    write(kOpen.data(), kOpen.size());
    std::this_thread::sleep_for(kLastReply);
    std::array<char, 512> old{};
    for (pollfd ready{port_, POLLIN, 0}; ::poll(&ready, 1, 0) > 0;) read(old.data(), old.size());
  }
  ~BareLawicel() override { static_cast<void>(!::write(port_, "C\r", 2)); }
  void exchange(const Sdo& request) override {
    std::array<char, 32> text{};
    int size = std::snprintf(text.data(), text.size(), "t%03X8", kRequest);
    for (const std::uint8_t byte : request)
      size += std::snprintf(text.data() + size, text.size() - static_cast<std::size_t>(size), "%02X", byte);
    text[static_cast<std::size_t>(size++)] = '\r';
    write(text.data(), static_cast<std::size_t>(size));
    // Acknowledgements and what the node says by itself are passed over.
    constexpr std::string_view kBegin = "t581";
    heard_.clear();
    for (std::size_t at = std::string::npos; at == std::string::npos || heard_.find('\r', at) == std::string::npos;) {
      std::array<char, 128> part{};
      heard_.append(part.data(), read(part.data(), part.size()));
      at = heard_.find(kBegin);
    }
  }

 private:
  std::string heard_;
};

}  // namespace

std::vector<double> bare_can_exchanges(const std::string& device, LineProtocol protocol,
                                       std::chrono::milliseconds lasting) {
  std::unique_ptr<BareCan> can;
  if (protocol == LineProtocol::slcan)
    can = std::make_unique<BareLawicel>(device);
  else
    can = std::make_unique<BareSocket>(device);
  std::vector<double> microseconds;
  const auto end = SteadyClock::now() + lasting;
  for (std::size_t i = 0; SteadyClock::now() < end; ++i) {
    for (const Sdo* request : {&kWrites[i % kWrites.size()], &kRead}) {
      const auto began = SteadyClock::now();
      can->exchange(*request);
      microseconds.push_back(std::chrono::duration<double, std::micro>(SteadyClock::now() - began).count());
    }
  }
  return microseconds;
}

}  // namespace axisgate::bench
