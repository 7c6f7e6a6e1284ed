// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/link/libmodbus_port.hpp"

#include <fmt/format.h>
#include <modbus/modbus.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/modbus_rtu/rtu_crc.hpp"
#include "adapters/serial/serial_port.hpp"

namespace axisgate::modbus_rtu {

namespace {

constexpr std::size_t kShortestReply = 8;        // of a write, CRC included
constexpr std::size_t kHeadOfRefusedLength = 3;  // unit, function and a byte count that no frame has
constexpr Byte kUntouched = 0xA5;
constexpr std::string_view kTakesNothing = ": it takes no bytes";

/// Bytes of the answer to this request, CRC included.
std::size_t reply_size(Bytes request) {
  if (request.size() < 6 || request[1] != static_cast<Byte>(Function::read_holding_registers)) return kShortestReply;
  return std::size_t{5} + 2 * std::size_t{load_be16(request, 4)};
}

/// Length of the frame that modbus_receive_confirmation() has read to its end, CRC included: by the function byte, as
/// libmodbus 3.1.6 does it. A function that it does not know, errors among them, has one byte of data.
std::size_t confirmation_size(Bytes frame) {
  const Byte function = frame[1];
  switch (function) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return 8;
    case MODBUS_FC_MASK_WRITE_REGISTER:
      return 10;
    default:
      break;
  }
  const bool counted = function <= MODBUS_FC_READ_INPUT_REGISTERS || function == MODBUS_FC_REPORT_SLAVE_ID ||
                       function == MODBUS_FC_WRITE_AND_READ_REGISTERS;
  return std::size_t{5} + (counted ? frame[2] : 0U);
}

}  // namespace

/// Never closed by libmodbus: modbus_close() would set the line as modbus_connect() found it, which was never called.
struct LibmodbusPort::Context {
  explicit Context(const serial::SerialSettings& settings)
      : modbus(modbus_new_rtu(settings.device.c_str(), static_cast<int>(settings.baud), 'N', 8, 1)) {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { modbus_free(modbus); }
  modbus_t* modbus;
};

LibmodbusPort::LibmodbusPort(serial::SerialSettings settings, Duration adapter_latency)
    : settings_(std::move(settings)), adapter_latency_(adapter_latency), longest_reply_(kShortestReply) {}

LibmodbusPort::~LibmodbusPort() { close(); }

LibmodbusPort::Opening LibmodbusPort::open() {
  // Not by modbus_connect(): it neither locks the port nor takes any rate, and on a pty its parity fails at times.
  serial::OpenedPort opened = serial::open_port(settings_);
  if (opened.descriptor < 0) return {std::move(opened.error), {}};
  descriptor_ = opened.descriptor;
  if (!selectable()) {
    Opening refused{fmt::format("{}: it got descriptor {}, and libmodbus serves none above {}: raise the hard limit of "
                                "open files (LimitNOFILE) or lower max_clients",
                                settings_.device, descriptor_, FD_SETSIZE - 1),
                    {}};
    close();
    return refused;
  }
  context_ = std::make_unique<Context>(settings_);
  if (context_->modbus == nullptr) {
    Opening refused{settings_.device + ": libmodbus refuses it: " + modbus_strerror(errno), {}};
    close();
    return refused;
  }
  modbus_set_socket(context_->modbus, descriptor_);
  modbus_set_error_recovery(context_->modbus, MODBUS_ERROR_RECOVERY_NONE);
  set_patience();
  return {{}, std::move(opened.notes)};
}

void LibmodbusPort::close() {
  context_.reset();
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

bool LibmodbusPort::selectable() const { return descriptor_ >= 0 && descriptor_ < FD_SETSIZE; }

/// Without a byte timeout the response timeout is the whole frame's, from its first bytes on (Linux's select() counts
/// it down): so a slave that drips bytes cannot hold us longer than a frame takes. The longest frame that anybody asked
/// for is the longest that has to be waited for.
void LibmodbusPort::set_patience() {
  const int parity_bits = settings_.parity == serial::Parity::none ? 0 : 1;
  const Duration patience = wire_time(settings_.baud, parity_bits, 0, longest_reply_) + adapter_latency_;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(patience).count();
  constexpr std::int64_t kSecond = 1'000'000;
  modbus_set_byte_timeout(context_->modbus, 0, 0);
  modbus_set_response_timeout(context_->modbus, static_cast<std::uint32_t>(us / kSecond),
                              static_cast<std::uint32_t>(us % kSecond));
}

std::string LibmodbusPort::transmit(Bytes frame) {
  if (!selectable()) return settings_.device + ": not open";
  if (const std::size_t reply = reply_size(frame); reply > longest_reply_) {
    longest_reply_ = reply;
    set_patience();
  }
  // Of this unit libmodbus judges the CRC. It knows none above 247: those it leaves to us, as all other units.
  static_cast<void>(modbus_set_slave(context_->modbus, frame[0]));
  const int size = static_cast<int>(frame.size());
  const int sent = modbus_send_raw_request(context_->modbus, frame.data(), size);
  if (sent == size + static_cast<int>(kCrcSize)) return {};
  const bool full = sent >= 0 || errno == EAGAIN || errno == EMBBADDATA;  // the last: only a part was taken
  return settings_.device + (full ? std::string(kTakesNothing) : std::string(": ") + modbus_strerror(errno));
}

std::size_t LibmodbusPort::bytes_waiting() const {
  int waiting = 0;
  if (descriptor_ < 0 || ::ioctl(descriptor_, FIONREAD, &waiting) != 0) return 0;
  return static_cast<std::size_t>(std::max(waiting, 0));
}

Heard LibmodbusPort::receive() {
  if (!selectable()) return {.kind = Heard::Kind::lost, .why = settings_.device + ": not open"};
  buffer_.fill(kUntouched);
  const int length = modbus_receive_confirmation(context_->modbus, buffer_.data());
  return length >= 0 ? judged(length) : failed(errno);
}

/// libmodbus returns 0, CRC unseen, for a whole frame from a unit other than the one set.
Heard LibmodbusPort::judged(int length) {
  const Bytes read(buffer_);
  const std::size_t size = length > 0 ? static_cast<std::size_t>(length) : confirmation_size(read);
  if (length == 0 && crc16(read.first(size)) != 0) return {.kind = Heard::Kind::noise, .bytes = size};
  return {.kind = Heard::Kind::frame, .frame = read.first(size - kCrcSize)};
}

Heard LibmodbusPort::failed(int error) {
  const Bytes read(buffer_);
  switch (error) {
    case EMBBADCRC:
      return {.kind = Heard::Kind::noise, .bytes = confirmation_size(read)};
    case EMBBADDATA:
      return {.kind = Heard::Kind::noise, .bytes = kHeadOfRefusedLength};
    case ETIMEDOUT:
    case EAGAIN: {
      // libmodbus does not say how many bytes it had: those that are no longer as we left them, but for bytes that
      // happen to be the same.
      const auto last = std::find_if(read.rbegin(), read.rend(), [](Byte byte) { return byte != kUntouched; });
      const auto bytes = static_cast<std::size_t>(read.rend() - last);
      return {.kind = bytes > 0 ? Heard::Kind::noise : Heard::Kind::nothing, .bytes = bytes};
    }
    case ECONNRESET:
      return {.kind = Heard::Kind::lost, .why = settings_.device + ": hung up"};
    default:
      return {.kind = Heard::Kind::lost, .why = settings_.device + ": " + modbus_strerror(error)};
  }
}

Heard LibmodbusPort::skip() {
  static_assert(kSkipSize <= std::tuple_size_v<decltype(buffer_)>);
  const ssize_t got = ::read(descriptor_, buffer_.data(), kSkipSize);
  if (got > 0) return {.kind = Heard::Kind::noise, .bytes = static_cast<std::size_t>(got)};
  if (got < 0 && errno == EAGAIN) return {};
  return {.kind = Heard::Kind::lost, .why = settings_.device + ": " + (got == 0 ? "hung up" : std::strerror(errno))};
}

}  // namespace axisgate::modbus_rtu
