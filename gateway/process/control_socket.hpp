// SPDX-License-Identifier: Apache-2.0
// Where a running gateway hears `axisgate reload`: an abstract Unix socket named after its configuration file, so that
// nothing is left on a disk and a read-only root will do. Promises to hear root and the gateway's own user alone (the
// kernel tells who it is), a bounded number of them at a time, each for a bounded time. Never does what is asked
// itself.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/process/reload.hpp"

namespace axisgate::process {

/// "reload\n" is what is said; the answer is kReloadDone or kReloadRefused, and the result's lines, one each.
inline constexpr std::string_view kReloadRequest = "reload\n";
/// Anything else of its length is answered by the end of the connection: a sign of life.
inline constexpr std::string_view kAliveRequest = "alive?\n";
static_assert(kAliveRequest.size() == kReloadRequest.size());
inline constexpr std::string_view kReloadDone = "done";
inline constexpr std::string_view kReloadRefused = "refused";

/// Its name; the same for every way to write the path of a file. Symbolic links are not followed: what they point to
/// may change while the gateway runs.
[[nodiscard]] std::string control_name(const std::string& config);

class ControlSocket {
 public:
  static constexpr std::size_t kMaxAskers = 8;
  static constexpr Duration kMaySpeakFor = std::chrono::seconds(5);

  /// `on_reload(done)`: somebody asks. Where the name is taken, that is a line of the log, and nobody is heard.
  ControlSocket(boost::asio::io_context& io, Runtime& runtime, const Log& log, const std::string& config,
                std::function<void(Reload::Done)> on_reload);
  ~ControlSocket();

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace axisgate::process
