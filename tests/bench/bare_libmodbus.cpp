#include "tests/bench/bare_libmodbus.hpp"

#include <modbus/modbus.h>
#include <sys/prctl.h>

#include <array>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <thread>

#include "tests/bench/line_protocol.hpp"

namespace axisgate::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;
/// A gateway that was ended in the middle of an exchange leaves a reply behind that comes later.
constexpr std::chrono::milliseconds kLastReply{50};

struct Free {
  void operator()(modbus_t* modbus) const {
    modbus_close(modbus);
    modbus_free(modbus);
  }
};

std::unique_ptr<modbus_t, Free> opened(const std::string& device) {
  constexpr int kUnit = 1;
  const int baud = static_cast<int>(baud_of(LineProtocol::modbus_rtu));
  std::unique_ptr<modbus_t, Free> modbus(modbus_new_rtu(device.c_str(), baud, 'N', 8, 1));
  if (modbus == nullptr || modbus_set_slave(modbus.get(), kUnit) != 0 || modbus_connect(modbus.get()) != 0)
    throw std::runtime_error(device + ": " + modbus_strerror(errno));
  std::this_thread::sleep_for(kLastReply);
  static_cast<void>(modbus_flush(modbus.get()));
  return modbus;
}

}  // namespace

std::vector<double> bare_rtu_exchanges(const std::string& device, std::chrono::microseconds silence,
                                       std::chrono::milliseconds lasting) {
  constexpr JdAddresses kAt = jd_addresses(LineProtocol::modbus_rtu);
  constexpr std::array<std::array<std::uint16_t, 2>, 2> kValues{{{0x86A0, 1}, {0x0D40, 3}}};  // 100000, 200000
  const auto modbus = opened(device);
  ::prctl(PR_SET_TIMERSLACK, 1UL);  // the silence is not to grow by 50 us
  std::vector<double> microseconds;
  auto over = SteadyClock::now();
  const auto exchange = [&](auto request) {
    const auto began = over;
    if (silence.count() > 0) std::this_thread::sleep_until(over + silence);
    if (request() < 0) throw std::runtime_error(device + ": " + modbus_strerror(errno));
    over = SteadyClock::now();
    microseconds.push_back(std::chrono::duration<double, std::micro>(over - began).count());
  };
  const auto end = over + lasting;
  for (std::size_t i = 0; over < end; ++i) {
    exchange([&] { return modbus_write_registers(modbus.get(), kAt.profile_velocity, 2, kValues[i % 2].data()); });
    std::uint16_t statusword = 0;
    exchange([&] { return modbus_read_registers(modbus.get(), kAt.statusword, 1, &statusword); });
  }
  ::prctl(PR_SET_TIMERSLACK, 0UL);
  return microseconds;
}

}  // namespace axisgate::bench
