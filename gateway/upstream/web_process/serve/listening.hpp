// SPDX-License-Identifier: Apache-2.0
// The sockets on which the page is served. Promises to open them all before anything is read, an address that this
// computer does not have yet too, where another of them is there. Never opens one later: the system refuses it by then.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/http/address.hpp"

namespace axisgate::web {

struct Listening {
  boost::asio::ip::tcp::acceptor acceptor;
  std::string address;    ///< as people write it: "127.0.0.1:8080"
  bool is_there = false;  ///< false: the address is none of this computer's yet
};

/// Throws program::StartError where an address is none, is in use, or needs rights; and where all are still to come.
[[nodiscard]] std::vector<Listening> open_listening(boost::asio::io_context& io,
                                                    const std::vector<std::string>& listen);

[[nodiscard]] Address address_of(const boost::asio::ip::address& address);

}  // namespace axisgate::web
