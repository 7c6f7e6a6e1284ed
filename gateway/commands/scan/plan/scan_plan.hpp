// SPDX-License-Identifier: Apache-2.0
// What `axisgate scan` asks of a CANopen bus, and what it makes of the answers: which nodes are there, who they say
// they are, and which profiles fit them. Pure: exchanges and results. Promises one exchange at a time, reads only, a
// bound on all of them, and that a node which falls silent is left. Never writes, starts or resets anything, and never
// proposes a foreign maker's profile: a profile is for the vendor that it names; one that names nobody, as some makers
// print no number, fits by its maker's own objects (2000h to 5FFFh), all of them; for any other CiA 402 drive there is
// cia402-generic.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/profile/read/profile.hpp"

namespace axisgate::commands {

/// Of a profile's readable objects on canopen, how many the drive has as the profile says.
struct ScanFit {
  /// Why it is thought to be for this drive, the strongest first.
  enum class By : std::uint8_t { vendor, objects, device_type };
  std::string profile;
  int has = 0;
  int of = 0;
  By by = By::objects;
  bool only_simulated = false;  ///< model::kOnlySimulated
  std::vector<profile::WantedConstant> wanted{};
  friend bool operator==(const ScanFit&, const ScanFit&) = default;
};

struct FoundNode {
  std::uint8_t node = 0;
  bus::NodeState state = bus::NodeState::unknown;          ///< by its heartbeat, if it sends one
  std::optional<std::uint32_t> device_type;                ///< 1000h
  std::array<std::optional<std::uint32_t>, 4> identity{};  ///< 1018h: vendor, product, revision, serial
  std::string name;                                        ///< 1008h, printable; empty: it has none
  bool fell_silent = false;                                ///< what follows its last answer is not known
  bool duplicate = false;                                  ///< two answers came to one request
  std::vector<ScanFit> fits;  ///< what may be proposed, the best first; those that have less than half are left out
  std::vector<std::string> of_vendor;  ///< profiles of its vendor that are for other products or revisions
  std::vector<std::string> nameless;   ///< profiles that fit wholly, but neither say nor show whose they are
};

/// Of two that fit alike, the one that more objects speak for.
[[nodiscard]] bool better_fit(const ScanFit& a, const ScanFit& b);

/// The node-IDs that are asked, both ends included.
struct ScanRange {
  std::uint8_t first = 1;
  std::uint8_t last = 127;
  [[nodiscard]] int count() const { return last - first + 1; }
  friend bool operator==(const ScanRange&, const ScanRange&) = default;
};
/// "5" or "1-10", of 1 to `last`; no value: neither.
[[nodiscard]] std::optional<ScanRange> parse_scan_range(std::string_view text, std::uint8_t last = 127);

class ScanPlan {
 public:
  static constexpr std::uint8_t kLastNode = 127;
  static constexpr int kSilences = 2;               ///< in a row: the node is left
  static constexpr std::size_t kMaxTried = 512;     ///< objects tried of one node
  static constexpr std::size_t kMaxNameParts = 64;  ///< exchanges for one device name

  /// Profiles without canopen are left out; none of the others may have faults.
  explicit ScanPlan(const std::vector<profile::Profile>& profiles, ScanRange range = {});

  /// A node that was heard is asked before all that were not.
  void heard(const bus::UnsolicitedEvent& unsolicited);
  /// The next read; none: the scan is over. The same answer until on_result().
  [[nodiscard]] std::optional<bus::Exchange> next() const;
  /// Of the exchange that next() gave. timed_out: nobody answered.
  void on_result(const bus::ExchangeResult& result);
  /// Nobody is known to be there yet.
  [[nodiscard]] bool knocking() const { return step_ == Step::knock; }
  [[nodiscard]] int nodes_asked() const { return asked_; }
  [[nodiscard]] const ScanRange& range() const { return range_; }
  /// In the order of their numbers.
  [[nodiscard]] std::vector<FoundNode> found() const;

 private:
  enum class Step : std::uint8_t { knock, identity, name, name_part, objects, over };
  struct Tried {
    ObjectAddress address;
    std::optional<std::uint8_t> size;  ///< as the node answered
  };
  void knock_on_next();
  void begin(Step step);
  void take_name(const bus::ExchangeResult& result);
  void end_node();
  [[nodiscard]] bool tells_widths() const;
  void judge(const profile::Profile& profile, bool widths_reported);

  std::vector<profile::Profile> profiles_;
  ScanRange range_;
  std::vector<Tried> tried_;
  std::vector<FoundNode> found_;
  std::array<bool, kLastNode + 1> done_{};
  std::array<std::optional<bus::NodeState>, kLastNode + 1> heard_{};
  FoundNode current_;
  Step step_ = Step::knock;
  std::size_t at_ = 0;  ///< identity number, name part or tried object
  int silences_ = 0;
  int asked_ = 0;
};

}  // namespace axisgate::commands
