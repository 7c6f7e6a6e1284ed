// SPDX-License-Identifier: Apache-2.0
// One write in one reading of the contract. Promises to change the world that it was given and nothing else.
#pragma once

#include <algorithm>
#include <functional>

#include "tests/model/contract.hpp"

namespace axisgate::test::reference {

/// Answers "which of the two readings?", a different way each time until all ways were tried.
class Readings {
 public:
  bool other() {
    if (next_ == path_.size()) path_.push_back(false);
    return path_[next_++];
  }
  /// False: all were tried.
  bool advance() {
    path_.resize(next_);
    next_ = 0;
    while (!path_.empty() && path_.back()) path_.pop_back();
    if (path_.empty()) return false;
    path_.back() = true;
    return true;
  }

 private:
  std::vector<bool> path_;
  std::size_t next_ = 0;
};

/// So long an enable or a stop is on its way that nobody has seen yet.
inline constexpr std::int64_t kUnderWayMs = 1000;
/// 3.4: stops act "without taking the lease", release "gives the lease back": whether set-points beside one take it is
/// not said.
[[nodiscard]] constexpr bool takes_no_lease(std::int64_t command) { return is_stop(command) || command == kRelease; }
/// Design 4, age: "Stops, jog_end and release are never refused for age or name."
[[nodiscard]] constexpr bool lets_go(std::int64_t command) { return takes_no_lease(command) || command == kJogEnd; }
[[nodiscard]] constexpr bool is_start(std::int64_t command) { return command >= kMove && command <= kHome; }

/// Of the result of a DDS request that is not run again.
inline constexpr int kAlreadySeen = 21;

class Judge {
 public:
  Judge(const ContractOptions& options, World& world, Readings& readings, const Seen& seen, std::size_t client)
      : options_(options), world_(world), readings_(readings), seen_(seen), client_(client) {}

  /// Any write of a client of Modbus or DDS.
  Verdict write(const Write& write);

  /// One that acts was in it.
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// The axis is its client's as soon as it is answered.
  [[nodiscard]] bool takes_over() const { return takes_over_; }
  /// What it is answered with is not said.
  [[nodiscard]] bool unclear() const { return unclear_; }
  /// Of a sample: its request_id was.
  void seen_before(SeenBefore seen) { seen_before_ = seen; }

 private:
  enum class Edge : std::uint8_t { absent, nothing, remembered, not_new, acts };

  Verdict registers(const Write& write);
  Verdict coils(const Write& write);
  Verdict sample(const Write& write);
  Verdict half(const Half& newest, const std::optional<Half>& before);
  [[nodiscard]] ClientMemory& me() { return world_.clients[std::min(client_, kModbus)]; }
  /// Of its address.
  [[nodiscard]] std::optional<std::int64_t>& last_id() {
    return world_.clients[std::min(options_.address_of(client_), kModbus)].id;
  }
  Edge edge(Item& item, std::int64_t value, bool single, bool stop);
  Edge new_or_not(Item& item, std::int64_t value, bool single, bool stop);
  Edge command_edge(const Rows& rows, bool single);
  Edge level_edge(std::uint16_t number, std::int64_t value, bool single);
  bool all_zero(const Write& write, const Rows& rows, Verdict& verdict);
  void setpoints(const Rows& rows, bool single, Edge command, Edge controlword, bool refused, bool was_empty);
  void accept(std::uint16_t offset, std::int64_t value, bool claims);
  [[nodiscard]] bool is_under_way() const;
  [[nodiscard]] bool start_refused(std::int64_t command, Verdict& verdict);
  /// False: it was refused, and nothing after it is carried out.
  bool controlword(std::int64_t value, bool single, Verdict& verdict);
  void command(std::int64_t number, Item& item, Verdict& verdict);
  void answer_not_new(std::int64_t number, const Item& item, Verdict& verdict);
  void stopped(bool asserted);
  void leave_motion();
  void halted(bool asserted);
  void speed_accepted();
  void renew_speed();
  [[nodiscard]] std::int64_t fastest_of(std::int64_t start) const;
  [[nodiscard]] bool at_rest() const;
  void claim();
  /// Another client owns the axis: what asks is refused, and what is refused changes nothing.
  [[nodiscard]] bool foreign() const;
  bool refuse_foreign(Verdict& verdict);
  void end_run(Verdict& verdict);
  void tell_foreign(Verdict& verdict) const;
  void jog(std::int64_t direction, std::int64_t value, Edge edge, bool single, Verdict& verdict);
  void jog_both(bool newly, Verdict& verdict);
  void begin_jog(std::int64_t direction, Verdict& verdict);
  void jog_sample(std::int64_t number, Verdict& verdict);
  bool reset_fault(Verdict& verdict);
  [[nodiscard]] bool may_have_no_halt() const;
  void take_over(Verdict& verdict);
  /// 3.3 What asks: "Set-points beside a command that is refused are accepted only if they would be without it": then
  /// they may be, or not.
  [[nodiscard]] static Verdict refused_whole() { return {"take_over is refused, and what stands beside it", {6}}; }
  void set_position(Verdict& verdict);
  void object(int function, Verdict& verdict);
  [[nodiscard]] bool forbidden(const Write& write) const;
  Verdict parameter(std::uint16_t offset, std::int64_t value);

  const ContractOptions& options_;
  World& world_;
  Readings& readings_;
  const Seen& seen_;
  std::size_t client_;
  bool refused_foreign_ = false;
  bool speed_here_ = false;    ///< a target_velocity stands in this request
  bool changes_mode_ = false;  ///< before its command: what becomes of a motion is not said
  bool stopped_ = false;
  bool takes_over_ = false;
  bool unclear_ = false;
  SeenBefore seen_before_ = SeenBefore::no;
};

}  // namespace axisgate::test::reference
