// SPDX-License-Identifier: Apache-2.0
// Reading one object by SDO upload: expedited, segmented, or in blocks of at most kMaxBlockSegments. A server may
// answer an object of four bytes or less in one segment as well. Promises that a frame is taken only if command,
// object, toggle and sequence are those it waits for; that content whose CRC or length is wrong is never handed on;
// that no more than kMaxObjectBytes are kept. Never sends anything by itself: begin(), next() and take() say what to
// send.
#pragma once

#include <vector>

#include "adapters/canopen/sdo/sdo_step.hpp"

namespace axisgate::canopen {

class SdoUpload {
 public:
  /// `whole`: four bytes at most are wanted (bus::Part::whole). `block`: the server offers block transfer. `unsaid`:
  /// the bytes of an answer that does not say how many it has.
  SdoUpload(ObjectAddress object, bool whole, bool block, std::size_t unsaid)
      : object_(object), whole_(whole), block_(block), unsaid_(unsaid) {}

  [[nodiscard]] SdoFrames begin();
  /// bus::Part::next: after an exchange that ended with `more`.
  [[nodiscard]] SdoFrames next();
  /// No value: not what is waited for.
  [[nodiscard]] std::optional<SdoStep> take(Bytes bytes);
  [[nodiscard]] ObjectAddress object() const { return object_; }
  [[nodiscard]] bool in_blocks() const { return in_blocks_; }

 private:
  enum class Awaited : std::uint8_t { nothing, initiate, block_initiate, segment, block_segment, block_end };

  [[nodiscard]] std::optional<SdoStep> on_initiate(const SdoReply& reply);
  [[nodiscard]] std::optional<SdoStep> on_value(const SdoReply& reply);
  [[nodiscard]] SdoStep on_begun(const SdoReply& reply, bool in_blocks);
  [[nodiscard]] SdoStep ask_for_segment();
  [[nodiscard]] SdoStep on_segment(const SdoReply& reply);
  [[nodiscard]] std::optional<SdoStep> on_block_segment(Bytes bytes);
  [[nodiscard]] SdoStep on_block(bool complete);
  [[nodiscard]] SdoStep on_block_end(const SdoReply& reply);
  [[nodiscard]] SdoStep on_abort(std::uint32_t code);
  [[nodiscard]] SdoStep too_long() const;
  [[nodiscard]] SdoStep no_field() const;
  [[nodiscard]] SdoStep content() const;

  ObjectAddress object_;
  bool whole_;
  bool block_;
  std::size_t unsaid_;
  Awaited awaited_ = Awaited::nothing;
  bool in_blocks_ = false;
  bool crc_ = false;
  bool toggle_ = false;
  bool started_ = false;       ///< of a block upload: the first block was asked for
  std::uint8_t sequence_ = 0;  ///< last segment of this block that came in its turn
  int barren_blocks_ = 0;
  std::optional<std::uint32_t> size_;
  std::vector<Byte> data_;
};

}  // namespace axisgate::canopen
