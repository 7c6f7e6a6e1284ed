// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/interface_watch.hpp"

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "gateway/core/bytes.hpp"

namespace axisgate::can {
namespace {

/// Reads in one turn of the loop; more messages wait for the next.
constexpr int kMaxReads = 16;
/// The kernel's own limit for one message of this kind is a page or 8 KiB.
constexpr std::size_t kMaxMessage = 16384;

int open_netlink() {
  const int descriptor = ::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (descriptor < 0) return -1;
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_LINK;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

/// Netlink aligns everything to 4 bytes (NLMSG_ALIGN, RTA_ALIGN).
constexpr std::size_t aligned(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

template <typename Header>
Header header_of(Bytes bytes) {
  Header header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

/// The first item of `rest`, header included, and `rest` without it; empty where nothing whole is left.
template <typename Header>
Bytes take_item(Bytes& rest, std::size_t (*length)(const Header&)) {
  if (rest.size() < sizeof(Header)) return {};
  const std::size_t size = length(header_of<Header>(rest));
  if (size < sizeof(Header) || size > rest.size()) return {};
  const Bytes item = rest.first(size);
  rest = rest.subspan(std::min(aligned(size), rest.size()));
  return item;
}

std::string_view name_in(Bytes attributes) {
  const auto length = [](const rtattr& attribute) { return std::size_t{attribute.rta_len}; };
  for (Bytes item; !(item = take_item<rtattr>(attributes, length)).empty();) {
    if (header_of<rtattr>(item).rta_type != IFLA_IFNAME) continue;
    const Bytes name = item.subspan(sizeof(rtattr));
    const std::string_view padded(reinterpret_cast<const char*>(name.data()), name.size());
    return padded.substr(0, padded.find('\0'));
  }
  return {};
}

std::optional<InterfaceChange> change_of(Bytes message, std::string_view interface) {
  const auto type = header_of<nlmsghdr>(message).nlmsg_type;
  if (type != RTM_NEWLINK && type != RTM_DELLINK) return std::nullopt;
  const Bytes content = message.subspan(sizeof(nlmsghdr));
  if (content.size() < sizeof(ifinfomsg) || name_in(content.subspan(sizeof(ifinfomsg))) != interface) {
    return std::nullopt;
  }
  const unsigned flags = header_of<ifinfomsg>(content).ifi_flags;
  InterfaceChange change;
  change.known = true;
  change.up = type == RTM_NEWLINK && (flags & IFF_UP) != 0;
  change.running = change.up && (flags & IFF_RUNNING) != 0;
  return change;
}

}  // namespace

InterfaceWatch::InterfaceWatch(boost::asio::io_context& context, std::string interface,
                               std::function<void(const InterfaceChange&)> on_change)
    : interface_(std::move(interface)), on_change_(std::move(on_change)), netlink_(context) {
  const int descriptor = open_netlink();
  if (descriptor < 0) return;  // then only the retries help
  netlink_.assign(descriptor);
  wait();
}

InterfaceWatch::~InterfaceWatch() = default;

void InterfaceWatch::wait() {
  netlink_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                      [this, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
                        if (alive.expired() || error) return;
                        if (drain()) wait();
                      });
}

bool InterfaceWatch::drain() {
  const std::weak_ptr alive(alive_);
  const auto length = [](const nlmsghdr& header) { return std::size_t{header.nlmsg_len}; };
  std::array<Byte, kMaxMessage> buffer{};
  for (int reads = 0; reads < kMaxReads; ++reads) {
    const ssize_t got = ::recv(netlink_.native_handle(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (got < 0 && errno == ENOBUFS) {
      on_change_({});
      if (alive.expired()) return false;
      continue;
    }
    if (got <= 0) break;
    Bytes rest = Bytes(buffer).first(static_cast<std::size_t>(got));
    for (Bytes message; !(message = take_item<nlmsghdr>(rest, length)).empty();) {
      const auto change = change_of(message, interface_);
      if (!change) continue;
      on_change_(*change);
      if (alive.expired()) return false;
    }
  }
  return true;
}

}  // namespace axisgate::can
