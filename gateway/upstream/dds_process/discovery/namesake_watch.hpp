// SPDX-License-Identifier: Apache-2.0
// Other participants that publish states of axes under our gateway's key: found by what their writers say of
// themselves, believed once a state of theirs was heard. Promises to tell each axis that such a writer has or has given
// up, and its end, once each, and nothing of what has changed back before its report. Never takes our own writer
// for another's, nor one of which nothing is heard: that of our own former process, which a discovery server still
// knows.
#pragma once

#include <bitset>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxNamesakesKnown = 64;
/// What one turn takes of them.
inline constexpr std::size_t kNamesakesPerTurn = 64;

/// What a gateway's writer of states says in its user data, for others of its key to know it by.
[[nodiscard]] std::vector<std::uint8_t> gateway_user_data(std::uint32_t key);

class NamesakeWatch {
 public:
  explicit NamesakeWatch(std::uint32_t key) : key_(key) {}

  // From any thread.
  void on_discovered(const Guid& writer, const std::vector<std::uint8_t>& user_data, const std::string& where);
  void on_removed(const Guid& writer);

  /// A sample of gateway_state of that writer was read; and its end.
  void on_gateway(const Guid& writer, std::uint32_t key);
  void on_gateway_gone(const Guid& writer);

  /// A state of that writer was read. `has`: it is not the last one of an axis that a reload has taken away.
  void on_state(const Guid& writer, std::uint32_t key, std::uint16_t axis, bool has);
  /// Somebody of our key is there, though perhaps silent: states are to be read.
  [[nodiscard]] bool any() const;
  /// To be reported since the last call, at most so many: the rest by the next.
  [[nodiscard]] std::vector<NamesakeRecord> take(std::size_t most);

 private:
  struct Other {
    std::string where{};
    std::bitset<kMaxAxisNumber + 1> axes{};
    std::bitset<kMaxAxisNumber + 1> reported{};
    bool gone = false;  ///< and its end is to be reported
  };
  const std::uint32_t key_;
  mutable std::mutex mutex_;
  std::map<Guid, Other> others_;
  std::set<Guid> gateways_;  ///< writers of gateway_state that have our key
};

}  // namespace axisgate::dds
