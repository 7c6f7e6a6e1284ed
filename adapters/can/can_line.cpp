// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/can_line.hpp"

#include <fmt/format.h>

#include <cassert>

#include "adapters/can/frame_bits.hpp"

namespace axisgate::can {

CanLine::CanLine(const std::string& bus, std::unique_ptr<CanLink> link, const Log& log, Describe describe)
    : log_source_(bus_source(bus)), log_(log), describe_(describe), link_(std::move(link)) {
  assert(link_ != nullptr);
}

void CanLine::on_up() {
  up_ = true;
  if (std::exchange(ever_up_, true)) ++statistics_.reconnects;
}

void CanLine::send(const CanFrame& frame, bool urgent) {
  log_frame("->", frame, "");
  count(frame);
  link_->send(frame, urgent);
}

void CanLine::count(const CanFrame& frame) { bits_ += static_cast<std::uint64_t>(bits_on_wire(frame)); }

const bus::Statistics& CanLine::statistics() const {
  const CanTrouble& trouble = link_->trouble();
  statistics_.dropped_bytes = trouble.lost_in + trouble.bad_bytes;
  return statistics_;
}

void CanLine::log_frame(std::string_view direction, const CanFrame& frame, std::string_view remark) const {
  if (!decode_) return;
  constexpr int kStandardDigits = 3, kExtendedDigits = 8;
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} {:0{}X} {}  {}{}", direction, frame.id, frame.extended ? kExtendedDigits : kStandardDigits,
                         frame.remote ? "remote" : hex_text(frame.bytes()), describe_(frame), remark),
             LogPace::each);
}

}  // namespace axisgate::can
