// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/raw_socket.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <vector>

namespace axisgate::can {
namespace {

/// The kernel makes it the smallest it allows, five or six frames. Few frames wait where nothing can call them back: an
/// urgent one overtakes in our own queue, and after a pulled cable no old commands go out when it is put back.
constexpr int kSendBufferBytes = 1;

template <typename Value>
bool set_option(int descriptor, int level, int option, const Value& value) {
  return ::setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

bool set_filters(int descriptor, const FilterSet& filters) {
  std::vector<can_filter> raw;
  for (const CanFilter& filter : filters.for_kernel()) {
    can_filter one{};
    one.can_id = filter.id | (filter.extended ? CAN_EFF_FLAG : 0U);
    one.can_mask = filter.mask | CAN_EFF_FLAG;
    raw.push_back(one);
  }
  static_assert(kMaxKernelFilters == CAN_RAW_FILTER_MAX);
  const auto size = static_cast<socklen_t>(raw.size() * sizeof(can_filter));
  const can_err_mask_t errors = CAN_ERR_MASK;
  return ::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), size) == 0 &&
         set_option(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors);
}

bool set_options(int descriptor, const FilterSet& filters) {
  const int on = 1;
  const int off = 0;
  // Beyond the system's limit with the right to; else as much as is allowed.
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBufferBytes)) {
    (void)set_option(descriptor, SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes);
  }
  (void)set_option(descriptor, SOL_SOCKET, SO_SNDBUF, kSendBufferBytes);
  return set_filters(descriptor, filters) && set_option(descriptor, SOL_CAN_RAW, CAN_RAW_LOOPBACK, on) &&
         set_option(descriptor, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, off) &&
         set_option(descriptor, SOL_SOCKET, SO_TIMESTAMPNS, on) && set_option(descriptor, SOL_SOCKET, SO_RXQ_OVFL, on);
}

/// 0, or why the interface cannot be used.
int bind_to(int descriptor, const std::string& interface, bool& running) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0) return errno;
  if ((request.ifr_flags & IFF_UP) == 0) return ENETDOWN;
  running = (request.ifr_flags & IFF_RUNNING) != 0;
  if (::ioctl(descriptor, SIOCGIFINDEX, &request) != 0) return errno;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return 0;
  // It was there a moment ago: so it is no CAN interface.
  return errno == ENODEV ? EAFNOSUPPORT : errno;
}

Duration duration_of(const timespec& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void take_control(msghdr& message, Received& received) {
  for (cmsghdr* control = CMSG_FIRSTHDR(&message); control != nullptr; control = CMSG_NXTHDR(&message, control)) {
    if (control->cmsg_level != SOL_SOCKET) continue;
    if (control->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(control), sizeof stamp);
      timespec now{};
      ::clock_gettime(CLOCK_REALTIME, &now);
      received.age = frame_age(duration_of(now), duration_of(stamp));
    } else if (control->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&received.dropped, CMSG_DATA(control), sizeof received.dropped);
    }
  }
}

void take_frame(const can_frame& raw, Received& received) {
  const std::size_t size = std::min<std::size_t>(raw.can_dlc, kMaxFrameBytes);
  const Bytes data(raw.data, size);
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    received.kind = Received::Kind::errors;
    received.errors = decode_errors(raw.can_id & CAN_ERR_MASK, data);
    return;
  }
  received.kind = Received::Kind::frame;
  CanFrame& frame = received.frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = static_cast<std::uint8_t>(size);
  if (!frame.remote) std::copy(data.begin(), data.end(), frame.data.begin());
}

}  // namespace

OpenedSocket open_raw_socket(const std::string& interface, std::uint32_t bitrate, const FilterSet& filters) {
  OpenedSocket opened;
  opened.descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (opened.descriptor < 0) {
    const bool no_can = errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT;
    opened.error = fmt::format(
        "{}: {}", interface,
        no_can ? "this kernel has no CAN: modprobe can_raw, or use a serial CAN adapter" : std::strerror(errno));
    return opened;
  }
  int error = set_options(opened.descriptor, filters) ? 0 : errno;
  if (error == 0) error = bind_to(opened.descriptor, interface, opened.running);
  if (error == 0) return opened;
  opened.error = interface_trouble(interface, bitrate, error);
  ::close(opened.descriptor);
  opened.descriptor = -1;
  return opened;
}

Received receive(int descriptor) {
  can_frame raw{};
  iovec part{&raw, sizeof raw};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  Received received;
  const ssize_t got = ::recvmsg(descriptor, &message, MSG_DONTWAIT);
  if (got < 0) {
    if (errno == EAGAIN || errno == EINTR) return received;
    received.kind = Received::Kind::failed;
    received.error = errno;
    return received;
  }
  received.kind = Received::Kind::other;
  if (static_cast<std::size_t>(got) == sizeof raw) take_frame(raw, received);
  take_control(message, received);
  return received;
}

Transmission transmit(int descriptor, const CanFrame& frame, int& error) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.size;
  std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
  if (::send(descriptor, &raw, sizeof raw, MSG_DONTWAIT) == static_cast<ssize_t>(sizeof raw)) {
    return Transmission::taken;
  }
  error = errno;
  const bool full = error == ENOBUFS || error == EAGAIN || error == EINTR;
  return full ? Transmission::queue_full : Transmission::failed;
}

bool takes_frames(int descriptor) {
  pollfd question{descriptor, POLLOUT, 0};
  return ::poll(&question, 1, 0) == 1 && (question.revents & POLLOUT) != 0;
}

std::string interface_trouble(const std::string& interface, std::uint32_t bitrate, int error) {
  switch (error) {
    case ENETDOWN:
      return fmt::format("{0} is down: ip link set {0} up type can bitrate {1}", interface, bitrate);
    case ENODEV:
    case ENXIO:
      return fmt::format("{} does not exist: is the adapter plugged in, and its driver loaded?", interface);
    case EAFNOSUPPORT:
      return fmt::format("{} is no CAN interface", interface);
    case EPERM:
    case EACCES:
      return fmt::format("{}: not allowed: {}", interface, std::strerror(error));
    default:
      return fmt::format("{}: {}", interface, std::strerror(error));
  }
}

}  // namespace axisgate::can
