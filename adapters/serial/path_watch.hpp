// SPDX-License-Identifier: Apache-2.0
// Tells when a path appears: a device plugged in, or udev's symlink to it made again.
// Promises at least one call for each appearance while its folder exists; a folder that comes and goes itself (udev
// removes an empty /dev/serial/by-id) is found again by renew(). Never opens or follows the path, and never reports
// twice in one turn.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/noncopyable.hpp>
#include <functional>
#include <memory>
#include <string>

namespace axisgate::serial {

class PathWatch : boost::noncopyable {
 public:
  /// `on_change` runs on the context's thread, not after the watch is destroyed.
  PathWatch(boost::asio::io_context& context, const std::string& path, std::function<void()> on_change);
  ~PathWatch();

  /// Looks for the folder again. False where it is not there, or the system has no watch left: then only retries help.
  bool renew();

 private:
  void wait();
  /// True if something about our name was among the events.
  bool drain();

  std::string folder_;
  std::string name_;
  std::function<void()> on_change_;
  boost::asio::posix::stream_descriptor inotify_;
  int watch_ = -1;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace axisgate::serial
