// SPDX-License-Identifier: Apache-2.0
// The SDO server of a CANopen node (CiA 301 7.2.4.3): expedited and segmented transfers, block transfers where switched
// on. Promises one transfer at a time and the abort codes of CiA 301 for what does not fit it.
// Never gives an object a meaning.
#pragma once

#include <optional>

#include "tests/simulated/can_device.hpp"

namespace axisgate::simulated {

struct SdoFacts {
  bool segmented = true;
  bool block = false;
  bool echoes_written = false;      // the acknowledgement repeats the data (JD 8.3, MD 4.3); else zeros
  bool short_frames = false;        // six bytes where an object has two or less, as JD 8.3 and MD 10.3 print it
  bool takes_short_frames = false;  // "send 8, accept less" (MD 4.3)
  std::uint8_t block_size = 16;     // segments in a block that it takes
  std::size_t longest_object = 4096;
};

class SdoServer {
 public:
  explicit SdoServer(const SdoFacts& facts) : facts_(facts) {}

  // What goes back, one entry for each frame: nothing to an abort, several in a block.
  std::vector<CanBytes> answer(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now);
  // What it would answer if it refused this request.
  CanBytes refusal(CanView request, std::uint32_t code) const;
  void reset() { stage_ = Stage::idle; }
  bool idle() const { return stage_ == Stage::idle; }
  SdoFacts& facts() { return facts_; }

 private:
  static constexpr std::size_t segment_bytes = 7;
  enum class Stage : std::uint8_t { idle, download, upload, block_download, block_end, block_upload, block_closing };
  using Replies = std::vector<CanBytes>;

  Replies initiate_download(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now);
  Replies download_segment(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now);
  Replies initiate_upload(CanView request, ObjectAccess& objects, Time now);
  Replies upload_segment(CanView request);
  Replies block_download(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now);
  Replies block_segment(CanView request);
  Replies block_upload(CanView request, ObjectAccess& objects, Time now);
  Replies send_block();
  Replies abort(std::uint32_t code);
  CanBytes plain(std::uint8_t command) const;
  void begin(CanView request, Stage stage);
  static ObjectKey key_in(CanView request) {
    return {static_cast<std::uint16_t>(request[1] | request[2] << 8), request[3]};
  }

  SdoFacts facts_;
  Stage stage_ = Stage::idle;
  ObjectKey key_{};
  CanBytes data_;
  std::size_t at_ = 0;
  std::optional<std::size_t> announced_;
  bool toggle_ = false;
  bool with_crc_ = false;
  bool last_seen_ = false;
  std::uint8_t sequence_ = 0;
  std::uint8_t host_block_ = 0;  // segments in a block that the host takes
};

// CRC-16-CCITT as block transfers use it: polynomial 1021h, begun with 0.
std::uint16_t sdo_crc(CanView bytes);

}  // namespace axisgate::simulated
