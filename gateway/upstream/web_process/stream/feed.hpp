// SPDX-License-Identifier: Apache-2.0
// The picture as all streams are sent it: made once, however many look. Pure: picture and instants in.
// Promises that what costs anything is done for what has changed alone, and once a second for what only grows older.
// Never keeps anything of a stream.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "gateway/upstream/web_process/api/gateway_json.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"
#include "gateway/upstream/web_process/stream/member_changes.hpp"

namespace axisgate::web {

/// An object that is sent whole.
struct WholeObject {
  std::string text;     ///< without its braces and without `at`
  Version version = 0;  ///< when it changed last
};

class Feed {
 public:
  static constexpr SteadyNs kRenewed = kSecond;

  void update(const Picture& picture, const Served& served, const Now& now);

  /// Another one for each hello: all that was sent before is void.
  [[nodiscard]] std::uint64_t generation() const { return generation_; }
  /// By number.
  [[nodiscard]] const std::map<std::uint16_t, MemberChanges>& axes() const { return axes_; }
  [[nodiscard]] const WholeObject& buses() const { return buses_; }
  [[nodiscard]] const WholeObject& gateway() const { return gateway_; }
  [[nodiscard]] bool joined() const { return joined_; }
  [[nodiscard]] Version version() const { return version_; }

 private:
  void update_axes(const Picture& picture, bool all, const Now& now);
  void update_whole(WholeObject& object, std::string text) const;

  std::uint64_t generation_ = 0;
  Version version_ = 0;
  bool joined_ = false;
  SteadyNs renewed_ = 0;  ///< when all were looked at
  std::map<std::uint16_t, MemberChanges> axes_;
  std::map<std::uint16_t, std::uint64_t> revisions_;  ///< of the sample that an axis was made from
  WholeObject buses_;
  WholeObject gateway_;
};

}  // namespace axisgate::web
