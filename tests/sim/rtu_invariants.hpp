// What must hold on a Modbus RTU line in every run: the same as on a Kinco one, told from its own frames, and what only
// the iD286pro needs. Promises to name the first violation. Never changes anything it looks at.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/sim/invariants.hpp"
#include "tests/unit/drive/rtu_truth.hpp"

namespace axisgate::test {

/// Told of each request on a line, before the line hears it.
using OnRtuRequest = std::function<void(const RtuRequest&)>;

/// I1 at most one exchange outstanding per bus; I5 no unique value written twice: seen on the cable.
class RtuCableWatch {
 public:
  RtuCableWatch(RtuLinkSim& link, Runtime& runtime, Duration timeout, std::function<void(std::string)> violated);
  /// Who else wants to know.
  void also_tell(OnRtuRequest on_request) { tell_.push_back(std::move(on_request)); }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  [[nodiscard]] std::uint64_t starts() const { return starts_; }  ///< moves of Kinco drives

 private:
  void to_drive(Bytes frame);
  [[nodiscard]] bool answered() const;

  RtuLinkSim& link_;
  Runtime& runtime_;
  Duration timeout_;
  std::function<void(std::string)> violated_;
  std::vector<OnRtuRequest> tell_;
  RtuRequest request_;
  std::vector<Byte> heard_;  ///< since the request
  Instant sent_at_ = kLongAgo;
  std::map<std::pair<Byte, std::uint32_t>, int> profile_velocities_;  ///< per unit and value
  std::uint64_t starts_ = 0;
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

/// I2, I6 and I10 of one drive. Of an iD286pro also: no motion that was not asked for, none while the axis is not
/// enabled, and not more writes of its memory than the budget has.
class RtuDriveWatch {
 public:
  RtuDriveWatch(const app::Gateway& gateway, RtuLinkSim& link, std::size_t position, AxisNumber axis,
                const Asked& asked, Runtime& runtime, std::function<void(std::string)> violated);
  void check();
  void on_request(const RtuRequest& request);
  [[nodiscard]] std::uint64_t starts() const { return moves_; }

 private:
  void check_values();
  void check_stepper(const simulated::Id286pro& stepper);
  void check_gate(const AxisImage& image);
  void check_start(const simulated::Id286proStart& start);
  void check_memory(const simulated::Id286pro& stepper);
  [[nodiscard]] bool keeps_its_word() const;
  void violated(const std::string& what) { violated_("axis " + std::to_string(axis_) + ": " + what); }

  const app::Gateway& gateway_;
  RtuLinkSim& link_;
  std::size_t position_;
  AxisNumber axis_;
  const Asked& asked_;
  Runtime& runtime_;
  std::function<void(std::string)> violated_;
  AxisWatch watch_;
  RtuTruth truth_;
  Instant began_;
  std::uint64_t starts_seen_ = 0;
  std::uint64_t moves_ = 0;
  bool enabled_ = false;  ///< as the axis was shown before this step
};

}  // namespace axisgate::test
