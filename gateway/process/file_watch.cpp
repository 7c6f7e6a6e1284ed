// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/file_watch.hpp"

#include <boost/asio/post.hpp>
#include <utility>

namespace axisgate::process {
FileWatch::FileWatch(boost::asio::io_context& io, Runtime& runtime, std::vector<profile::FileRead> read,
                     std::function<void(const std::string& file)> on_change)
    : io_(io),
      runtime_(runtime),
      watched_(std::move(read)),
      on_change_(std::move(on_change)),
      timer_(runtime.make_timer([this] { look(); })) {
  timer_->expires_at(runtime_.now() + kPeriod);
}

void FileWatch::take(std::vector<profile::FileRead> read) {
  boost::asio::post(thread_, [this, read = std::move(read)]() mutable { watched_ = std::move(read); });
}

// The next look waits for the end of this one.
void FileWatch::look() {
  boost::asio::post(thread_, [this, alive = std::weak_ptr(alive_)] {
    std::string differs;
    for (const profile::FileRead& each : watched_)
      if (differs.empty() && profile::read_file(each.file) != each) differs = each.file;
    boost::asio::post(io_, [this, alive, differs] {
      if (!alive.expired()) on_looked(differs);
    });
  });
}

void FileWatch::on_looked(const std::string& file) {
  timer_->expires_at(runtime_.now() + kPeriod);
  if (file.empty() == reported_.empty()) return;
  reported_ = file;
  on_change_(file);
}

}  // namespace axisgate::process
