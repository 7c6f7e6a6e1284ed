// SPDX-License-Identifier: Apache-2.0
#include "adapters/serial/serial_link.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <cassert>
#include <utility>

#include "adapters/serial/serial_port.hpp"
#include "adapters/serial/still_open.hpp"

namespace axisgate::serial {

namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;

char parity_letter(Parity parity) { return parity == Parity::none ? 'N' : parity == Parity::even ? 'E' : 'O'; }

}  // namespace

SerialLink::SerialLink(std::string name, SerialSettings settings, asio::io_context& context, Runtime& runtime,
                       const Log& log)
    : log_source_(bus_source(std::move(name))),
      settings_(std::move(settings)),
      context_(context),
      runtime_(runtime),
      log_(log),
      port_(context),
      timer_(runtime.make_timer([this] { try_open(); })) {
  unsent_.reserve(kMaxUnsent);
}

SerialLink::~SerialLink() = default;

void SerialLink::start(bus::ByteLinkEvents& events) {
  assert(events_ == nullptr);
  events_ = &events;
  path_watch_ = std::make_unique<PathWatch>(context_, settings_.device, [this] {
    plan_.on_path(runtime_.now());
    arm();
  });
  plan_.on_request(runtime_.now());
  arm();
}

void SerialLink::arm() { timer_->expires_at(plan_.due()); }

void SerialLink::try_open() {
  if (port_.is_open()) return;
  path_watch_->renew();  // before the try: what appears after it is then told
  OpenedPort opened = open_port(settings_);
  if (opened.descriptor < 0) {
    plan_.on_failure(runtime_.now());
    arm();
    failures_.tell(log_, log_source_, opened.error);
    return;
  }
  port_.assign(opened.descriptor);
  port_.non_blocking(true);  // known to Asio too: else write_some() would wait until all is written
  plan_.on_open();
  arm();
  ++*opening_;
  failures_.opened();
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} open, {} baud 8{}1", settings_.device, settings_.baud, parity_letter(settings_.parity)));
  if (opened.notes != last_notes_) {
    for (const std::string& note : opened.notes) {
      log_.write(LogLevel::warning, log_source_, settings_.device + ": " + note);
    }
    last_notes_ = std::move(opened.notes);
  }
  read();
  events_->on_link_up();
}

void SerialLink::read() {
  port_.async_read_some(asio::buffer(incoming_),
                        [this, still_open = StillOpen(opening_)](const Error& error, std::size_t size) {
                          if (!still_open) return;
                          if (error) {
                            lose(device_and(error));
                            return;
                          }
                          events_->on_bytes(Bytes(incoming_).first(size));
                          if (still_open) read();
                        });
}

void SerialLink::send(Bytes bytes) {
  if (!port_.is_open()) return;
  if (unsent_.size() + bytes.size() > kMaxUnsent) {
    lose_later(settings_.device + ": it takes no bytes");
    return;
  }
  unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
  if (!writing_) write();
}

void SerialLink::write() {
  Error error;
  std::size_t written = 0;
  do {
    written = port_.write_some(asio::buffer(unsent_), error);
  } while (error == asio::error::interrupted);  // by a signal (SIGHUP reloads): the line is there
  unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(written));
  if (error && error != asio::error::would_block) {
    lose_later(device_and(error));
    return;
  }
  writing_ = !unsent_.empty();
  if (!writing_) return;
  port_.async_wait(asio::posix::stream_descriptor::wait_write,
                   [this, still_open = StillOpen(opening_)](const Error& wait_error) {
                     if (still_open && !wait_error) write();
                   });
}

void SerialLink::lose_later(std::string why) {
  asio::post(context_, [this, still_open = StillOpen(opening_), why = std::move(why)] {
    if (still_open) lose(why);
  });
}

void SerialLink::lose(const std::string& why) {
  close();
  plan_.on_loss(runtime_.now());
  arm();
  events_->on_link_down(why);
}

void SerialLink::reopen(std::string_view why) {
  const bool was_open = port_.is_open();
  close();
  plan_.on_request(runtime_.now());
  arm();
  if (was_open) events_->on_link_down(fmt::format("{}: {}", settings_.device, why));
}

void SerialLink::close() {
  ++*opening_;
  Error ignored;  // the descriptor is gone either way
  port_.close(ignored);
  unsent_.clear();
  writing_ = false;
}

std::string SerialLink::device_and(const Error& error) const {
  const std::string reason = error == asio::error::eof ? "hung up" : error.message();
  return settings_.device + ": " + reason;
}

}  // namespace axisgate::serial
