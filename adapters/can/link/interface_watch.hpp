// SPDX-License-Identifier: Apache-2.0
// Tells when a network interface appears, goes, or is taken up or down: rtnetlink's messages.
// Promises at least one call for each change that the system tells, and one when it says that messages were lost.
// Never asks for the state, and never changes it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/noncopyable.hpp>
#include <functional>
#include <memory>
#include <string>

namespace axisgate::can {

struct InterfaceChange {
  bool known = false;    ///< false: messages were lost, and the rest means nothing
  bool up = false;       ///< by the administrator
  bool running = false;  ///< the driver says that it works: false while bus-off
};

class InterfaceWatch : boost::noncopyable {
 public:
  /// `on_change` runs on the context's thread, not after the watch is destroyed.
  InterfaceWatch(boost::asio::io_context& context, std::string interface,
                 std::function<void(const InterfaceChange&)> on_change);
  ~InterfaceWatch();

 private:
  void wait();
  /// False: the watch was destroyed by what it called.
  bool drain();

  std::string interface_;
  std::function<void(const InterfaceChange&)> on_change_;
  boost::asio::posix::stream_descriptor netlink_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace axisgate::can
