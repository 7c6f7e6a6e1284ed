#include "tests/bench/bare_of.hpp"

#include "tests/bench/bare_can.hpp"
#include "tests/bench/bare_libmodbus.hpp"
#include "tests/bench/bare_loop.hpp"

namespace axisgate::bench {

std::vector<double> bare_exchanges_of(const DriveProcess& drives, std::chrono::microseconds silence,
                                      std::chrono::milliseconds lasting) {
  switch (drives.shape().protocol) {
    case LineProtocol::modbus_rtu:
      return bare_rtu_exchanges(drives.device(), silence, lasting);
    case LineProtocol::slcan:
    case LineProtocol::vcan:
      return bare_can_exchanges(drives.device(), drives.shape().protocol, lasting);
    case LineProtocol::kinco_serial:
      break;
  }
  return bare_exchanges(drives.device(), lasting);
}

}  // namespace axisgate::bench
