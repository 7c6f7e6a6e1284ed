// SPDX-License-Identifier: Apache-2.0
// Objects that one request reads together: neighbouring registers of one poll class inside a run without holes, or all
// values that one answer of the drive holds (Keya: at differing bytes), which come along for nothing. Promises that a
// block never leaves its run nor exceeds what the drive reads at once, and that a run which the drive refused is split
// for good, so that one bad register never spoils the others. Never decides when anything is read.
#pragma once

#include <concepts>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/device/poll_plan.hpp"

namespace axisgate::drive {

/// One request of the poll plan, as long as the drive refuses none.
struct PlannedRead {
  model::PollClass poll_class = model::PollClass::normal;
  bus::Exchange exchange;
};
/// What keeping the image of these axes true asks of the bus: each request once.
[[nodiscard]] std::vector<PlannedRead> planned_reads(const model::DriveModel& model);

class ReadBlocks {
 public:
  /// A request that stays without any answer this often in a row is taken for refused.
  static constexpr int kSilences = 2;

  explicit ReadBlocks(const model::DriveModel& model);

  /// Makes a plain read of one object one of all objects of its block that are wanted as well.
  template <std::predicate<model::ObjectId> Wanted>
  void widen(bus::Exchange& exchange, Wanted wanted) const {
    const std::size_t at = block_of(exchange);
    if (at == kNone) return;
    bus::Exchange wide = exchange;
    wide.size = 0;
    for (const model::ObjectId id : blocks_[at].objects)
      if (blocks_[at].one_answer || wanted(id) || model_.object(id).address == exchange.object) add(wide, id);
    exchange = wide;
  }

  /// It reads the values of one answer, not a run: refused or unanswered, it is so as a whole.
  [[nodiscard]] bool one_answer(const bus::Exchange& exchange) const {
    const std::size_t at = block_of(exchange);
    return at != kNone && blocks_[at].one_answer;
  }
  /// The drive refused this exchange: its block falls in two. False: it read one object, and that is what is refused.
  bool refused(const bus::Exchange& exchange);
  /// It was not answered at all. True: once too often, and its block fell in two.
  bool silent(const bus::Exchange& exchange);
  void answered(const bus::Exchange& exchange);

 private:
  struct Block {
    std::vector<model::ObjectId> objects;  ///< by ascending register, or byte
    int silences = 0;
    bool one_answer = false;
  };
  static constexpr std::size_t kNone = SIZE_MAX;
  void pack(const std::vector<model::ObjectId>& neighbours);
  void group_answers();
  [[nodiscard]] std::size_t block_of(const bus::Exchange& exchange) const;
  void add(bus::Exchange& exchange, model::ObjectId id) const;

  const model::DriveModel& model_;
  std::vector<Block> blocks_;
};

}  // namespace axisgate::drive
