// SPDX-License-Identifier: Apache-2.0
// The room of the history: chunks of runs, in memory that is taken as it is needed, up to a bound.
// Promises that where none is free the chunk is given that was written longest ago, of whichever series: so all series
// reach back equally far. Never gives memory back: what was taken once is taken again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/upstream/web_process/values/series.hpp"

namespace axisgate::web {

/// A value from its first sample to its last one, or a gap. Instants in microseconds.
struct Run {
  static constexpr std::uint32_t kLongest = 0x7FFFFFFF;

  std::uint32_t begin = 0;        ///< since the chunk's
  std::uint32_t bits = 0;         ///< of the value, as registers have them
  std::uint32_t length : 31 = 0;  ///< to its last sample
  std::uint32_t known : 1 = 0;    ///< 0: a gap
};
static_assert(sizeof(Run) == 12);

struct Chunk {
  static constexpr std::size_t kRuns = 32;

  std::int64_t begin = 0;  ///< microseconds on the steady clock
  std::array<Run, kRuns> runs{};
  std::uint32_t older = 0;  ///< the one written before it, and behind it
  std::uint32_t newer = 0;
  Series owner{};
  std::uint16_t count = 0;  ///< of runs

  [[nodiscard]] std::int64_t begin_of(const Run& run) const { return begin + run.begin; }
  [[nodiscard]] std::int64_t end_of(const Run& run) const { return begin + run.begin + run.length; }
  [[nodiscard]] Run& newest() { return runs.at(count - 1U); }
};

class ChunkPool {
 public:
  using Place = std::uint32_t;

  explicit ChunkPool(std::size_t bytes) : most_(bytes / sizeof(Chunk) < kLeast ? kLeast : bytes / sizeof(Chunk)) {}

  /// The chunk that take() would take from its owner; none: one is free.
  [[nodiscard]] std::optional<Place> next_taken() const;
  /// An empty one. Whoever owned it has lost it.
  Place take(Series owner);
  void give_back(Place place);
  /// Something was written into it now.
  void written(Place place);

  [[nodiscard]] Chunk& operator[](Place place) { return (*blocks_[place / kBlock])[place % kBlock]; }
  [[nodiscard]] const Chunk& operator[](Place place) const { return (*blocks_[place / kBlock])[place % kBlock]; }
  [[nodiscard]] std::size_t bytes() const { return used_ * sizeof(Chunk); }

 private:
  static constexpr Place kNone = UINT32_MAX;
  static constexpr std::size_t kBlock = 256;
  static constexpr std::size_t kLeast = 4;
  using Block = std::array<Chunk, kBlock>;

  void link_newest(Place place);
  void unlink(Place place);

  std::size_t most_;
  std::size_t used_ = 0;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::size_t made_ = 0;  ///< of the places in blocks_, those that were ever taken
  std::vector<Place> free_;
  Place oldest_ = kNone;
  Place newest_ = kNone;
};

}  // namespace axisgate::web
