// SPDX-License-Identifier: Apache-2.0
// Which members of one JSON object have changed since when. Promises that whoever asks for the changes since a version
// that it has gets, put over what it has, what is now: so nothing needs to be kept for anybody, and what a slow reader
// is sent late is the newest. Never knows what a member means.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace axisgate::web {

/// Counts up with each look; 0: nothing was sent yet.
using Version = std::uint64_t;

class MemberChanges {
 public:
  /// @param nested members that are objects whose own members are sent one by one
  explicit MemberChanges(std::vector<std::string> nested) : nested_(std::move(nested)) {}

  /// What it is now. @param version greater than all before
  void update(const nlohmann::ordered_json& object, Version version);
  [[nodiscard]] Version changed() const { return changed_; }
  /// `"name":value` of all that changed behind `since`, with commas between; of a nested member those of its members,
  /// null for one that is gone. Since 0: all there is.
  [[nodiscard]] std::string since(Version since) const;

 private:
  struct Leaf {
    std::string text;
    Version version = 0;
    bool gone = false;
  };
  using Leaves = std::vector<std::pair<std::string, Leaf>>;
  struct Member {
    std::string name;
    bool nested = false;
    Leaf leaf{};      ///< of one that is not nested
    Leaves inside{};  ///< of one that is
  };
  void note(Leaf& leaf, std::string text, Version version);
  void update_inside(Leaves& leaves, const nlohmann::ordered_json& object, Version version);
  [[nodiscard]] Member& member(const std::string& name);

  std::vector<std::string> nested_;
  std::vector<Member> members_;
  Version changed_ = 0;
};

}  // namespace axisgate::web
