// SPDX-License-Identifier: Apache-2.0
// Who asked an axis for what, what was refused or did not come about, and why: for log and events. Promises that no
// client can fill them (see telling.hpp). Never decides anything.
#pragma once

#include <string>

#include "gateway/drive/axis/axis_host.hpp"
#include "gateway/drive/axis/pending_batches.hpp"
#include "gateway/drive/axis/telling.hpp"
#include "gateway/drive/guard/guard.hpp"

namespace axisgate::drive {

class AxisEvents {
 public:
  AxisEvents(const AxisCore& core, const AxisImage& image, const Guard& guard, AxisHost& host)
      : core_(core), image_(image), guard_(guard), host_(host) {}

  /// `carried_out`: what has become of a coil that ends a run, or of a stop beside which something was refused.
  void asked(const WriteBatch& asked, const WriteBatch& carried_out);
  void refused(const WriteBatch& asked, const BatchResult& result);
  void ended(const Pending& pending, const Outcome& outcome);
  void not_reached(const Pending& pending);
  void owner(const std::string& what);
  void event(EventKind kind, std::uint32_t code, std::string text) {
    host_.event(image_.number, kind, code, std::move(text));
  }

 private:
  const AxisCore& core_;
  const AxisImage& image_;
  const Guard& guard_;
  AxisHost& host_;
  Telling telling_;
};

}  // namespace axisgate::drive
