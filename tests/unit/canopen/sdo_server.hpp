// SPDX-License-Identifier: Apache-2.0
// An SDO server by the letter of CiA 301 section 7.2.4.3, written for the tests alone, with switches for what a server
// may do wrong. Requests in, replies out.
#pragma once

#include <map>

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

  [[nodiscard]] std::vector<ByteRow> hear(const ByteRow& q) {
    if (state_ == State::block_down && (q[0] != 0x80)) return block_segment(q);
    switch (q[0] >> 5) {
      case 0:
        return download_segment(q);
      case 1:
        return begin_download(q);
      case 2:
        return begin_upload(q);
      case 3:
        return upload_segment(q);
      case 4:
        aborts_heard.push_back(load_le(q, 4, 4));
        state_ = State::idle;
        return {};
      case 5:
        return block_upload(q);
      default:
        return block_download(q);
    }
  }
  [[nodiscard]] bool idle() const { return state_ == State::idle; }

  static std::uint16_t crc_of(const ByteRow& bytes) {
    unsigned crc = 0;
    for (const Byte byte : bytes) {
      crc ^= static_cast<unsigned>(byte) << 8;
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? (crc << 1) ^ 0x1021U : crc << 1;
      crc &= 0xFFFFU;
    }
    return static_cast<std::uint16_t>(crc);
  }

 private:
  enum class State { idle, segments_down, segments_up, block_down, block_down_end, block_up };

  static ByteRow reply(Byte command, const ByteRow& q) { return {command, q[1], q[2], q[3], 0, 0, 0, 0}; }
  static ByteRow with_size(ByteRow row, std::size_t size) {
    store_le(row, 4, 4, static_cast<std::uint32_t>(size));
    return row;
  }
  std::vector<ByteRow> abort(const ByteRow& q, std::uint32_t code) {
    state_ = State::idle;
    return {with_size(reply(0x80, q), code)};
  }
  void open(const ByteRow& q) {
    header_ = q;
    index_ = load_le16(q, 1);
    data_.clear();
    at_ = 0;
    toggle_ = 0;
  }

  std::vector<ByteRow> begin_download(const ByteRow& q) {
    open(q);
    if ((q[0] & 0x02) != 0) {
      objects[index_] = ByteRow(q.begin() + 4, q.end() - ((q[0] >> 2) & 3));
      state_ = State::idle;
    } else {
      state_ = State::segments_down;
    }
    return {reply(0x60, q)};
  }
  std::vector<ByteRow> download_segment(const ByteRow& q) {
    if (state_ != State::segments_down || (q[0] & 0x10) != toggle_) return abort(header_, 0x05030000);
    data_.insert(data_.end(), q.begin() + 1, q.end() - ((q[0] >> 1) & 7));
    ByteRow done(8, 0);
    done[0] = static_cast<Byte>(0x20 | toggle_);
    toggle_ ^= 0x10;
    if ((q[0] & 1) != 0) finish_download();
    return {done};
  }
  void finish_download() {
    objects[index_] = data_;
    state_ = State::idle;
  }
  std::vector<ByteRow> begin_upload(const ByteRow& q) {
    open(q);
    if (objects.count(index_) == 0) return abort(q, 0x06020000);
    data_ = objects[index_];
    if (data_.size() <= 4 && !data_.empty()) {
      ByteRow row = reply(static_cast<Byte>(0x43 | ((4 - data_.size()) << 2)), q);
      std::copy(data_.begin(), data_.end(), row.begin() + 4);
      state_ = State::idle;
      return {row};
    }
    state_ = State::segments_up;
    return {indicates_size ? with_size(reply(0x41, q), data_.size()) : reply(0x40, q)};
  }
  std::vector<ByteRow> upload_segment(const ByteRow& q) {
    if (state_ != State::segments_up || (q[0] & 0x10) != toggle_) return abort(header_, 0x05030000);
    const std::size_t count = std::min<std::size_t>(7, data_.size() - at_);
    const bool last = at_ + count == data_.size();
    ByteRow row(8, 0);
    row[0] = static_cast<Byte>(toggle_ | ((7 - count) << 1) | (last ? 1 : 0));
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at_), count, row.begin() + 1);
    at_ += count;
    toggle_ ^= 0x10;
    if (last) state_ = State::idle;
    return {row};
  }

  std::vector<ByteRow> block_download(const ByteRow& q) {
    if ((q[0] & 1) != 0) {
      if (state_ != State::block_down_end) return abort(header_, 0x05040001);
      data_.erase(data_.end() - ((q[0] >> 2) & 7), data_.end());
      if (does_crc && load_le16(q, 1) != crc_of(data_)) return abort(header_, 0x05040004);
      finish_download();
      return {ByteRow{0xA1, 0, 0, 0, 0, 0, 0, 0}};
    }
    open(q);
    if (!offers_block) return abort(q, 0x05040001);
    state_ = State::block_down;
    sequence_ = 0;
    ByteRow row = reply(static_cast<Byte>(0xA0 | (does_crc ? 4 : 0)), q);
    row[4] = block_size;
    return {row};
  }
  std::vector<ByteRow> block_segment(const ByteRow& q) {
    const int sequence = q[0] & 0x7F;
    const bool last = (q[0] & 0x80) != 0;
    const bool lost = std::erase(lose, sequence) > 0;
    const bool in_turn = !lost && sequence == sequence_ + 1;
    if (in_turn) {
      ++sequence_;
      data_.insert(data_.end(), q.begin() + 1, q.end());
    }
    if (!last && sequence != block_size) return {};
    if (last && in_turn) state_ = State::block_down_end;
    const ByteRow row{0xA2, static_cast<Byte>(sequence_), block_size, 0, 0, 0, 0, 0};
    sequence_ = 0;
    return {row};
  }
  std::vector<ByteRow> block_upload(const ByteRow& q) {
    switch (q[0] & 3) {
      case 0:
        return begin_block_upload(q);
      case 3:
        return block();
      case 2:
        at_ += static_cast<std::size_t>(q[1]) * 7;
        segments_ = q[2];
        if (at_ < data_.size()) return block();
        return {end_of_blocks()};
      default:
        state_ = State::idle;
        return {};
    }
  }
  std::vector<ByteRow> begin_block_upload(const ByteRow& q) {
    if (!offers_block) return abort(q, 0x05040001);
    const auto object = objects.find(load_le16(q, 1));
    if (honours_threshold && object != objects.end() && object->second.size() <= q[5]) return begin_upload(q);
    open(q);
    if (object == objects.end()) return abort(q, 0x06020000);
    data_ = object->second;
    segments_ = q[4];
    state_ = State::block_up;
    const auto command = static_cast<Byte>(0xC0 | (does_crc ? 4 : 0) | (indicates_size ? 2 : 0));
    return {indicates_size ? with_size(reply(command, q), data_.size()) : reply(command, q)};
  }
  std::vector<ByteRow> block() {
    std::vector<ByteRow> rows;
    for (int sequence = 1; sequence <= segments_; ++sequence) {
      const std::size_t at = at_ + static_cast<std::size_t>(sequence - 1) * 7;
      if (at >= data_.size()) break;
      const std::size_t count = std::min<std::size_t>(7, data_.size() - at);
      ByteRow row(8, 0);
      row[0] = static_cast<Byte>(sequence | (at + count == data_.size() ? 0x80 : 0));
      std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at), count, row.begin() + 1);
      if (std::erase(lose, sequence) == 0) rows.push_back(row);
    }
    return rows;
  }
  [[nodiscard]] ByteRow end_of_blocks() const {
    const auto unused = static_cast<Byte>((7 - data_.size() % 7) % 7);
    ByteRow row{static_cast<Byte>(0xC1 | (unused << 2)), 0, 0, 0, 0, 0, 0, 0};
    if (does_crc) store_le16(row, 1, crc_of(data_));
    return row;
  }

  State state_ = State::idle;
  ByteRow header_ = ByteRow(8, 0);
  std::uint16_t index_ = 0;
  ByteRow data_;
  std::size_t at_ = 0;
  Byte toggle_ = 0;
  int sequence_ = 0;
  int segments_ = 0;
};

}  // namespace axisgate::test
