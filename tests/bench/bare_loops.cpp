// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bare_loops.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <modbus/modbus.h>
#include <net/if.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "tests/simulated/ten_byte_frame.hpp"

namespace axisgate::bench {
namespace {

using Sdo = std::array<std::uint8_t, 8>;

/// A gateway that was ended in the middle of an exchange leaves a reply behind that comes later.
constexpr std::chrono::milliseconds kLastReply{50};
constexpr std::uint32_t kSdoRequest = 0x601, kSdoReply = 0x581;

/// A host of drive 1 that can do two things.
class BareHost {
 public:
  BareHost() = default;
  BareHost(const BareHost&) = delete;
  BareHost& operator=(const BareHost&) = delete;
  virtual ~BareHost() = default;
  /// 100000 or 200000, to the profile velocity.
  virtual void write_parameter(bool other) = 0;
  virtual void read_statusword() = 0;
};

class Port {
 public:
  Port(int descriptor, const std::string& device) : descriptor_(descriptor) {
    if (descriptor_ < 0) throw std::runtime_error(device + ": " + std::strerror(errno));
  }
  ~Port() { ::close(descriptor_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  void write(const void* bytes, std::size_t size) const {
    if (::write(descriptor_, bytes, size) != static_cast<ssize_t>(size))
      throw std::runtime_error("the port takes no bytes");
  }
  std::size_t read(void* bytes, std::size_t size) const {
    if (!readable(1000)) throw std::runtime_error("no reply for 1 s");
    const ssize_t got = ::read(descriptor_, bytes, size);
    if (got <= 0) throw std::runtime_error("the port hung up");
    return static_cast<std::size_t>(got);
  }
  void forget_old_replies() const {
    std::this_thread::sleep_for(kLastReply);
    for (std::array<char, 512> old{}; readable(0);) read(old.data(), old.size());
  }

 private:
  [[nodiscard]] bool readable(int milliseconds) const {
    pollfd ready{descriptor_, POLLIN, 0};
    return ::poll(&ready, 1, milliseconds) > 0;
  }
  int descriptor_;
};

int serial_port(const std::string& device) { return ::open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC); }

class KincoHost final : public BareHost {
 public:
  explicit KincoHost(const std::string& device) : port_(serial_port(device), device) { port_.forget_old_replies(); }
  void write_parameter(bool other) override { exchange(other ? kOther : kOne); }
  void read_statusword() override { exchange(kRead); }

 private:
  using Command = simulated::FrameCommand;
  void exchange(const simulated::TenByteFrame& request) const {
    port_.write(request.data(), request.size());
    simulated::TenByteFrame reply;
    for (std::size_t got = 0; got < reply.size();) got += port_.read(reply.data() + got, reply.size() - got);
  }

  const simulated::TenByteFrame kOne = simulated::seal(1, Command::write_4, 0x6081, 0, 100'000);
  const simulated::TenByteFrame kOther = simulated::seal(1, Command::write_4, 0x6081, 0, 200'000);
  const simulated::TenByteFrame kRead = simulated::seal(1, Command::read, 0x6041, 0, 0);
  Port port_;
};

class ModbusHost final : public BareHost {
 public:
  explicit ModbusHost(const std::string& device)
      : device_(device), modbus_(modbus_new_rtu(device.c_str(), baud_of(LineProtocol::modbus_rtu), 'N', 8, 1)) {
    constexpr int kUnit = 1;
    if (modbus_ == nullptr || modbus_set_slave(modbus_.get(), kUnit) != 0 || modbus_connect(modbus_.get()) != 0) fail();
    std::this_thread::sleep_for(kLastReply);
    static_cast<void>(modbus_flush(modbus_.get()));
  }
  void write_parameter(bool other) override {
    constexpr std::array<std::array<std::uint16_t, 2>, 2> kValues{{{0x86A0, 1}, {0x0D40, 3}}};
    if (modbus_write_registers(modbus_.get(), kAt.profile_velocity, 2, kValues[other ? 1 : 0].data()) < 0) fail();
  }
  void read_statusword() override {
    std::uint16_t statusword = 0;
    if (modbus_read_registers(modbus_.get(), kAt.statusword, 1, &statusword) < 0) fail();
  }

 private:
  static constexpr JdAddresses kAt = jd_addresses(LineProtocol::modbus_rtu);
  struct Free {
    void operator()(modbus_t* modbus) const {
      modbus_close(modbus);
      modbus_free(modbus);
    }
  };
  [[noreturn]] void fail() const { throw std::runtime_error(device_ + ": " + modbus_strerror(errno)); }
  std::string device_;
  std::unique_ptr<modbus_t, Free> modbus_;
};

/// Expedited SDO requests to node 1.
class CanHost : public BareHost {
 public:
  void write_parameter(bool other) override {
    exchange(other ? Sdo{0x23, 0x81, 0x60, 0, 0x40, 0x0D, 0x03, 0} : Sdo{0x23, 0x81, 0x60, 0, 0xA0, 0x86, 0x01, 0});
  }
  void read_statusword() override { exchange(Sdo{0x40, 0x41, 0x60, 0, 0, 0, 0, 0}); }

 private:
  virtual void exchange(const Sdo& request) = 0;
};

class SocketHost final : public CanHost {
 public:
  explicit SocketHost(const std::string& interface)
      : port_(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW), interface) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    const can_filter filter{kSdoReply, CAN_SFF_MASK};
    if (::setsockopt(port_.descriptor(), SOL_CAN_RAW, CAN_RAW_FILTER, &filter, sizeof filter) != 0 ||
        ::bind(port_.descriptor(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error(interface + ": " + std::strerror(errno));
    port_.forget_old_replies();
  }

 private:
  void exchange(const Sdo& request) override {
    can_frame frame{};
    frame.can_id = kSdoRequest;
    frame.can_dlc = static_cast<std::uint8_t>(request.size());
    std::ranges::copy(request, std::begin(frame.data));
    port_.write(&frame, sizeof frame);
    port_.read(&frame, sizeof frame);
  }
  Port port_;
};

class LawicelHost final : public CanHost {
 public:
  explicit LawicelHost(const std::string& device) : port_(serial_port(device), device) {
    constexpr std::string_view kOpen = "\rC\rS6\rO\r";
    port_.write(kOpen.data(), kOpen.size());
    port_.forget_old_replies();
  }
  ~LawicelHost() override { static_cast<void>(!::write(port_.descriptor(), "C\r", 2)); }

 private:
  void exchange(const Sdo& request) override {
    std::array<char, 32> text{};
    int size = std::snprintf(text.data(), text.size(), "t%03X8", kSdoRequest);
    for (const std::uint8_t byte : request)
      size += std::snprintf(text.data() + size, text.size() - static_cast<std::size_t>(size), "%02X", byte);
    text[static_cast<std::size_t>(size++)] = '\r';
    port_.write(text.data(), static_cast<std::size_t>(size));
    // Acknowledgements and what the node says by itself are passed over.
    heard_.clear();
    for (std::size_t at = std::string::npos; at == std::string::npos || heard_.find('\r', at) == std::string::npos;) {
      std::array<char, 128> part{};
      heard_.append(part.data(), port_.read(part.data(), part.size()));
      at = heard_.find("t581");
    }
  }
  Port port_;
  std::string heard_;
};

std::unique_ptr<BareHost> host_of(const DriveProcess& drives) {
  switch (drives.shape().protocol) {
    case LineProtocol::modbus_rtu:
      return std::make_unique<ModbusHost>(drives.device());
    case LineProtocol::slcan:
      return std::make_unique<LawicelHost>(drives.device());
    case LineProtocol::vcan:
      return std::make_unique<SocketHost>(drives.device());
    case LineProtocol::kinco_serial:
      break;
  }
  return std::make_unique<KincoHost>(drives.device());
}

}  // namespace

Samples bare_exchanges(const DriveProcess& drives, std::chrono::milliseconds lasting,
                       std::chrono::microseconds silence) {
  const bool silent = drives.shape().protocol == LineProtocol::modbus_rtu && silence.count() > 0;
  const auto host = host_of(drives);
  ::prctl(PR_SET_TIMERSLACK, 1UL);  // the silence is not to grow by 50 us
  Samples microseconds;
  auto over = SteadyClock::now();
  const auto exchange = [&](const auto& request) {
    const auto began = over;
    if (silent) std::this_thread::sleep_until(over + silence);
    request();
    over = SteadyClock::now();
    microseconds.push_back(std::chrono::duration<double, std::micro>(over - began).count());
  };
  const auto end = over + lasting;
  for (bool other = false; over < end; other = !other) {
    exchange([&] { host->write_parameter(other); });
    exchange([&] { host->read_statusword(); });
  }
  ::prctl(PR_SET_TIMERSLACK, 0UL);
  return microseconds;
}

}  // namespace axisgate::bench
