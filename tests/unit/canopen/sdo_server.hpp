// SPDX-License-Identifier: Apache-2.0
// The SDO server of the simulated drives (CiA 301 section 7.2.4.3, no code of the gateway's) with a map of objects
// behind it, and switches for what a server may do otherwise or wrong. Requests in, replies out.
#pragma once

#include <map>

#include "tests/simulated/sdo_server.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::test {

class SdoServer {
 public:
  std::map<std::uint16_t, ByteRow> objects;
  bool offers_block = false;
  bool does_crc = true;
  bool indicates_size = true;
  bool honours_threshold = false;  ///< short objects are answered without blocks though blocks were asked for
  std::uint8_t block_size = 16;    ///< of a download
  /// Of the next block that comes or goes, these segments get lost.
  std::vector<int> lose;
  std::vector<std::uint32_t> aborts_heard;

  [[nodiscard]] std::vector<ByteRow> hear(ByteRow q) {
    server_.facts() = {.block = offers_block, .block_size = block_size, .longest_object = 1U << 20};
    if (q[0] == kAbort) aborts_heard.push_back(load_le(q, 4, 4));
    // Out of turn, and the end of a block all the same.
    if (takes_block_ && std::erase(lose, q[0] & kSequence) > 0)
      q[0] = static_cast<Byte>((q[0] & ~kSequence) | ((q[0] & kSequence) == block_size ? kSequence : 0));
    const bool begins_block =
        !takes_block_ && (q[0] >> 5 == kBlockDownload || q[0] >> 5 == kBlockUpload) && (q[0] & 3) != 3;
    if (begins_block && !does_crc) q[0] = static_cast<Byte>(q[0] & ~kCrc);
    if (q[0] >> 5 == kBlockUpload && (q[0] & 3) == 0 && honours_threshold && is_short(q)) q[0] = kUpload;
    Objects access(objects);
    std::vector<ByteRow> rows = server_.answer(q, access, 0, {});
    for (ByteRow& row : rows) answer_otherwise(row);
    if (q[0] >> 5 == kBlockUpload && (q[0] & 3) != 0)
      std::erase_if(rows, [this](const ByteRow& row) { return std::erase(lose, row[0] & kSequence) > 0; });
    return rows;
  }
  [[nodiscard]] bool idle() const { return server_.idle(); }

 private:
  static constexpr Byte kAbort = 0x80, kSequence = 0x7F, kCrc = 0x04, kUpload = 0x40;
  static constexpr Byte kBlockUpload = 5, kBlockDownload = 6;
  static constexpr Byte kSegmentsUp = 0x41, kBlocksUp = 0xC6, kBlocksDown = 0xA4, kBlockTaken = 0xA2;

  class Objects final : public simulated::ObjectAccess {
   public:
    explicit Objects(std::map<std::uint16_t, ByteRow>& objects) : objects_(objects) {}
    simulated::ObjectReply read(simulated::ObjectKey key, simulated::Time) override {
      const auto found = objects_.find(key.index);
      return found == objects_.end() ? simulated::ObjectReply{0x06020000} : simulated::ObjectReply{0, found->second};
    }
    std::uint32_t write(simulated::ObjectKey key, simulated::CanView bytes, std::uint64_t, simulated::Time) override {
      objects_[key.index] = ByteRow(bytes.begin(), bytes.end());
      return 0;
    }

   private:
    std::map<std::uint16_t, ByteRow>& objects_;
  };

  bool is_short(const ByteRow& q) const {
    const auto object = objects.find(load_le16(q, 1));
    return object != objects.end() && object->second.size() <= q[5];
  }
  void answer_otherwise(ByteRow& row) {
    if (row[0] == kSegmentsUp || row[0] == kBlocksUp) {
      if (!indicates_size) {
        row[0] = static_cast<Byte>(row[0] == kSegmentsUp ? row[0] & ~1 : row[0] & ~2);
        store_le(row, 4, 4, 0);
      }
      if (!does_crc && (row[0] & 0xC0) == 0xC0) row[0] = static_cast<Byte>(row[0] & ~kCrc);
    }
    takes_block_ = row[0] == kBlocksDown || (row[0] == kBlockTaken && takes_block_);
    if (row[0] == kBlocksDown && !does_crc) row[0] = static_cast<Byte>(row[0] & ~kCrc);
  }

  simulated::SdoServer server_{{}};
  bool takes_block_ = false;
};

}  // namespace axisgate::test
