// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/link/libmodbus_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <unistd.h>
#include <boost/noncopyable.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/serial/serial_port.hpp"
#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_rtu {

namespace {

constexpr std::size_t kShortestReply = 8;  // of a write, CRC included
constexpr std::string_view kTakesNothing = ": it takes no bytes";

/// Bytes of the answer to this request, CRC included.
std::size_t reply_size(Bytes request) {
  if (request.size() < 6) return kShortestReply;
  const std::size_t count = load_be16(request, 4);
  switch (static_cast<Function>(request[1])) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
      return 5 + (count + 7) / 8;
    case Function::read_holding_registers:
    case Function::read_input_registers:
      return 5 + 2 * count;
    default:
      return kShortestReply;
  }
}

/// The clock of the patience with a half frame; the core's own is on another thread.
Instant clock_now() { return Instant(std::chrono::steady_clock::now().time_since_epoch()); }

}  // namespace

/// Never closed by libmodbus: modbus_close() would set the line as modbus_connect() found it, which was never called.
struct LibmodbusPort::Context : private boost::noncopyable {
  explicit Context(const serial::SerialSettings& settings)
      : modbus(modbus_new_rtu(settings.device.c_str(), static_cast<int>(settings.baud), 'N', 8, 1)) {
    static_cast<void>(::pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK));
  }
  ~Context() {
    modbus_free(modbus);
    for (const int end : pipe) {
      if (end >= 0) ::close(end);
    }
  }
  [[nodiscard]] bool works() const { return modbus != nullptr && pipe[0] >= 0; }

  modbus_t* modbus;
  std::array<int, 2> pipe{-1, -1};  ///< by which it is given frames; its reading end first
};

LibmodbusPort::LibmodbusPort(serial::SerialSettings settings, Duration adapter_latency)
    : settings_(std::move(settings)), adapter_latency_(adapter_latency), longest_reply_(kShortestReply) {}

LibmodbusPort::~LibmodbusPort() { close(); }

LibmodbusPort::Opening LibmodbusPort::open() {
  // Not by modbus_connect(): it neither locks the port nor takes any rate, and on a pty its parity fails at times.
  serial::OpenedPort opened = serial::open_port(settings_);
  if (opened.descriptor < 0) return {std::move(opened.error), {}};
  descriptor_ = opened.descriptor;
  context_ = std::make_unique<Context>(settings_);
  if (!context_->works()) {
    Opening refused{settings_.device + ": libmodbus refuses it: " + modbus_strerror(errno), {}};
    close();
    return refused;
  }
  if (!selectable()) {
    Opening refused{fmt::format("{}: it got descriptor {}, and libmodbus serves none above {}: raise the hard limit of "
                                "open files (LimitNOFILE) or lower max_clients",
                                settings_.device, std::max(descriptor_, context_->pipe[0]), FD_SETSIZE - 1),
                    {}};
    close();
    return refused;
  }
  modbus_set_error_recovery(context_->modbus, MODBUS_ERROR_RECOVERY_NONE);
  // It is given whole frames, and waits for nothing.
  modbus_set_byte_timeout(context_->modbus, 0, 0);
  modbus_set_response_timeout(context_->modbus, 0, 1);
  return {{}, std::move(opened.notes)};
}

void LibmodbusPort::close() {
  context_.reset();
  finder_ = {};
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

bool LibmodbusPort::selectable() const {
  return descriptor_ >= 0 && descriptor_ < FD_SETSIZE && context_ != nullptr && context_->pipe[0] < FD_SETSIZE;
}

/// The whole frame's, from its first bytes on: so a slave that drips bytes cannot hold us longer than a frame takes.
/// The longest frame that anybody asked for is the longest that has to be waited for.
Duration LibmodbusPort::patience() const {
  const int parity_bits = settings_.parity == serial::Parity::none ? 0 : 1;
  return wire_time(settings_.baud, parity_bits, 0, longest_reply_) + adapter_latency_;
}

Duration LibmodbusPort::patience_left() const { return std::max(begun_at_ + patience() - clock_now(), Duration{}); }

std::string LibmodbusPort::transmit(Bytes frame) {
  if (!selectable()) return settings_.device + ": not open";
  longest_reply_ = std::max(longest_reply_, reply_size(frame));
  std::array<Byte, kMaxFrame + kCrcSize> whole{};
  std::ranges::copy(frame, whole.begin());
  const std::uint16_t crc = crc16(frame);
  whole.at(frame.size()) = static_cast<Byte>(crc & 0xFF);
  whole.at(frame.size() + 1) = static_cast<Byte>(crc >> 8);
  finder_.sent(Bytes(whole).first(frame.size() + kCrcSize));
  modbus_set_socket(context_->modbus, descriptor_);
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

Heard LibmodbusPort::receive(bool may_read) {
  if (!selectable()) return {.kind = Heard::Kind::lost, .why = settings_.device + ": not open"};
  while (true) {
    const FrameFinder::Found found = finder_.next(!may_read && patience_left() == Duration{});
    if (found.kind != FrameFinder::Found::Kind::nothing) {
      begun_at_ = clock_now();  // of what follows
      return heard_of(found);
    }
    if (!may_read) return {};
    Heard lost;
    may_read = read_more(lost);
    if (lost.kind == Heard::Kind::lost) return lost;
  }
}

/// False: there is no more.
bool LibmodbusPort::read_more(Heard& lost) {
  std::array<Byte, FrameFinder::kHolds> bytes{};
  const ssize_t got = ::read(descriptor_, bytes.data(), finder_.room());
  if (got > 0) {
    if (!finder_.unfinished()) begun_at_ = clock_now();
    finder_.take(Bytes(bytes).first(static_cast<std::size_t>(got)));
    return true;
  }
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  lost = {.kind = Heard::Kind::lost, .why = settings_.device + ": " + (got == 0 ? "hung up" : std::strerror(errno))};
  return false;
}

Heard LibmodbusPort::heard_of(const FrameFinder::Found& found) {
  using Kind = FrameFinder::Found::Kind;
  switch (found.kind) {
    case Kind::copy:
      return {.kind = Heard::Kind::frame, .frame = found.bytes.first(found.bytes.size() - kCrcSize)};
    case Kind::frame:
      return judged(found.bytes);
    case Kind::glitch:
      return {.kind = Heard::Kind::glitch, .bytes = found.bytes.size()};
    case Kind::noise:
      return {.kind = Heard::Kind::noise, .bytes = found.bytes.size()};
    case Kind::nothing:
      break;
  }
  return {};
}

/// libmodbus returns 0, CRC unseen, for a whole frame from a unit other than the one set.
Heard LibmodbusPort::judged(Bytes frame) {
  const auto [reading, writing] = context_->pipe;
  const ssize_t given = ::write(writing, frame.data(), frame.size());
  modbus_set_socket(context_->modbus, reading);
  const int length = modbus_receive_confirmation(context_->modbus, buffer_.data());
  while (::read(reading, buffer_.data(), buffer_.size()) > 0) continue;  // of a frame that it measures otherwise
  const bool whole = given == static_cast<ssize_t>(frame.size()) && (length > 0 ? length == given : length == 0);
  if (whole && crc16(frame) == 0) {
    return {.kind = Heard::Kind::frame, .frame = frame.first(frame.size() - kCrcSize)};
  }
  const std::size_t bytes = frame.size();
  return {.kind = Heard::Kind::noise, .bytes = bytes + finder_.drop()};
}

Heard LibmodbusPort::skip() {
  static_assert(kSkipSize <= std::tuple_size_v<decltype(buffer_)>);
  const ssize_t got = ::read(descriptor_, buffer_.data(), kSkipSize);
  if (got > 0) return {.kind = Heard::Kind::noise, .bytes = static_cast<std::size_t>(got)};
  if (got < 0 && errno == EAGAIN) return {};
  return {.kind = Heard::Kind::lost, .why = settings_.device + ": " + (got == 0 ? "hung up" : std::strerror(errno))};
}

}  // namespace axisgate::modbus_rtu
