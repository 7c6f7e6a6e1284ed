// SPDX-License-Identifier: Apache-2.0
// Writing one object by SDO download: expedited, segmented, or in blocks of at most kMaxBlockSegments.
// Promises that an acknowledgement is taken only if command, object, toggle and sequence are those it waits for, and
// that a server which wants longer blocks gets segments instead.
// Never sends anything by itself: begin(), next() and take() say what to send.
#pragma once

#include <vector>

#include "adapters/canopen/sdo/sdo_step.hpp"

namespace axisgate::canopen {

class SdoDownload {
 public:
  /// `data`: 1 to kMaxObjectBytes. `block`: the server offers block transfer.
  SdoDownload(ObjectAddress object, Bytes data, bool block);

  [[nodiscard]] SdoFrames begin();
  /// bus::Part::next: after an exchange that ended with `more`.
  [[nodiscard]] SdoFrames next();
  /// No value: not what is waited for.
  [[nodiscard]] std::optional<SdoStep> take(Bytes bytes);
  [[nodiscard]] ObjectAddress object() const { return object_; }
  [[nodiscard]] bool in_blocks() const { return in_blocks_; }

 private:
  enum class Awaited : std::uint8_t { nothing, initiate, block_initiate, segment, block, block_end };

  [[nodiscard]] bool expedited() const { return data_.size() <= kExpeditedBytes; }
  [[nodiscard]] bool complete() const { return acknowledged_ == data_.size(); }
  [[nodiscard]] SdoFrames next_block();
  [[nodiscard]] SdoFrame begin_segmented();
  [[nodiscard]] SdoStep leave_blocks(bool tell_server);
  [[nodiscard]] SdoStep on_begun();
  [[nodiscard]] SdoStep on_block_begun(const SdoReply& reply);
  [[nodiscard]] SdoStep on_segment();
  [[nodiscard]] std::optional<SdoStep> on_block(const SdoReply& reply);

  ObjectAddress object_;
  std::vector<Byte> data_;
  bool block_;
  Awaited awaited_ = Awaited::nothing;
  bool in_blocks_ = false;
  bool crc_ = false;
  bool toggle_ = false;
  std::uint8_t segments_ = 0;      ///< of a block, as the server wants them
  std::uint8_t sent_ = 0;          ///< segments of this block
  std::size_t acknowledged_ = 0;   ///< bytes
  std::size_t on_wire_bytes_ = 0;  ///< of the segment that is to be acknowledged
  int barren_blocks_ = 0;
};

}  // namespace axisgate::canopen
