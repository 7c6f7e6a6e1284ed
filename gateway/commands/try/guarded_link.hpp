// SPDX-License-Identifier: Apache-2.0
// A CAN link of a trial: what leaves is looked at first. Promises that while it only reads, nothing but requests to
// read an object (CiA 301, SDO upload) leaves, whatever the layers above send, and that while heartbeats are withheld
// neither the gateway's own nor a node guarding request does; and that where it writes objects alone, nothing but
// reads and writes of objects leaves. Never changes a frame.
#pragma once

#include <memory>
#include <vector>

#include "adapters/can/can_link.hpp"

namespace axisgate::commands {

/// Shared with whoever decides; outlives the link.
struct LinkGuard {
  bool only_reads = true;
  bool writes_objects = false;  ///< beside the reads, writes of objects may leave (SDO download)
  bool withholds = false;
};
/// Pure.
[[nodiscard]] bool may_leave(const LinkGuard& guard, const can::CanFrame& frame);
/// While it only reads, what a node says by itself is not heard: it would be set up for it.
[[nodiscard]] bool may_enter(const LinkGuard& guard, const can::CanFrame& frame);

class GuardedLink final : public can::CanLink, private can::CanLinkEvents {
 public:
  GuardedLink(std::unique_ptr<can::CanLink> link, const LinkGuard& guard) : guard_(guard), link_(std::move(link)) {}

  void start(can::CanLinkEvents& events, std::vector<can::CanFilter> filters) override;
  void send(const can::CanFrame& frame, bool urgent) override;
  [[nodiscard]] const can::CanTrouble& trouble() const override { return link_->trouble(); }

 private:
  void on_link_up() override { events_->on_link_up(); }
  void on_link_down(std::string_view why) override { events_->on_link_down(why); }
  void on_frame(const can::CanFrame& frame, Instant received) override;

  const LinkGuard& guard_;
  can::CanLinkEvents* events_ = nullptr;
  std::unique_ptr<can::CanLink> link_;
};

}  // namespace axisgate::commands
