// SPDX-License-Identifier: Apache-2.0
// Other gateways that publish axes under our key: two of one name in a domain, to which every command would go.
// Promises that one which was seen counts until its writer is gone, as long as the two have an axis in common, also one
// that a reload has added; that an axis counts no more once the other has given it up; and that what was known before
// axisgate-dds was restarted counts until others have had the time to be found again. Never counts a participant
// that says nothing.
#pragma once

#include <bitset>
#include <map>
#include <string>

#include "gateway/core/clock.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// Writers of states under our key that are known at a time; those beyond are not seen until one is gone.
inline constexpr std::size_t kMaxNamesakes = 64;

class Namesakes {
 public:
  explicit Namesakes(const ProcessImage& image) : image_(image) {}

  void on_record(const NamesakeRecord& record);
  void on_link_up(Instant until);
  void on_time(Instant now);
  [[nodiscard]] Instant deadline() const { return until_; }

  /// Starts and enables are refused.
  [[nodiscard]] bool taken() const { return shared() != 0; }
  /// "axis 3 of 192.168.1.8", of the first of them.
  [[nodiscard]] std::string text() const;

 private:
  struct Other {
    std::bitset<kMaxAxisNumber + 1> axes{};
    std::string where{};
    bool seen = true;  ///< since the link is up
  };
  /// The first axis that is one of ours and of another gateway of our key, and whose; 0: there is none.
  [[nodiscard]] AxisNumber shared(const Other** whose = nullptr) const;

  const ProcessImage& image_;
  std::map<Guid, Other> others_;
  Instant until_ = kNever;
};

}  // namespace axisgate::dds
