// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/guarded_link.hpp"

#include <utility>

namespace axisgate::commands {
namespace {

// CiA 301: COB-IDs of the predefined connection set, and the client's command specifiers (bits 5 to 7 of byte 0).
constexpr std::uint32_t kFunction = 0x780;
constexpr std::uint32_t kSdoToNode = 0x600, kSdoFromNode = 0x580, kErrorControl = 0x700;
constexpr unsigned kSpecifierAt = 5;
enum Specifier : unsigned { upload = 2, upload_segment = 3, abort_transfer = 4, block_upload = 5, block_download = 6 };

}  // namespace

bool may_leave(const LinkGuard& guard, const can::CanFrame& frame) {
  const std::uint32_t function = frame.id & kFunction;
  if (guard.withholds && function == kErrorControl) return false;
  if (!guard.only_reads) return true;
  if (frame.extended || frame.remote || function != kSdoToNode || frame.size == 0) return false;
  const unsigned specifier = static_cast<unsigned>(frame.data[0]) >> kSpecifierAt;
  if (guard.writes_objects) return specifier <= block_download;
  return specifier >= upload && specifier <= block_upload;
}

bool may_enter(const LinkGuard& guard, const can::CanFrame& frame) {
  return !guard.only_reads || (!frame.extended && (frame.id & kFunction) == kSdoFromNode);
}

void GuardedLink::start(can::CanLinkEvents& events, std::vector<can::CanFilter> filters) {
  events_ = &events;
  link_->start(*this, std::move(filters));
}

void GuardedLink::send(const can::CanFrame& frame, bool urgent) {
  if (may_leave(guard_, frame)) link_->send(frame, urgent);
}

void GuardedLink::on_frame(const can::CanFrame& frame, Instant received) {
  if (may_enter(guard_, frame)) events_->on_frame(frame, received);
}

}  // namespace axisgate::commands
