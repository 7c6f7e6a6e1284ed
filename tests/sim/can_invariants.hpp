// What must hold on a CAN bus in every run: the same as on a serial line, told from its own frames, and what only
// CANopen needs. Promises to name the first violation. Never changes anything it looks at.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/sim/invariants.hpp"
#include "tests/stage/can_link_sim.hpp"

namespace axisgate::test {

/// Told of each frame that the gateway has sent or was given.
using OnCanFrame = std::function<void(bool towards_drive, const can::CanFrame&)>;

/// I1 at most one SDO exchange outstanding per bus; I5 no unique value written twice: seen on the cable.
class CanCableWatch {
 public:
  CanCableWatch(CanLinkSim& link, Runtime& runtime, Duration timeout, std::function<void(std::string)> violated);
  /// Who else wants to know, before a frame is delivered.
  void also_tell(OnCanFrame on_frame) { tell_.push_back(std::move(on_frame)); }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  [[nodiscard]] std::uint64_t starts() const { return starts_; }

 private:
  void to_drive(const can::CanFrame& frame);
  void to_host(const can::CanFrame& frame);
  void request(const can::CanFrame& frame);
  [[nodiscard]] bool over() const;
  [[nodiscard]] bool answers(const can::CanFrame& frame) const;

  Runtime& runtime_;
  Duration timeout_;
  std::function<void(std::string)> violated_;
  std::vector<OnCanFrame> tell_;
  can::CanFrame request_;
  Instant sent_at_ = kLongAgo;                                                 ///< kLongAgo: nothing is outstanding
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> profile_velocities_;  ///< per node and value
  std::uint64_t starts_ = 0;
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

/// I2, I6 and I10 of one drive. Beside them: nothing valid of before its start or of a node that has said nothing for
/// long, and no NMT command to a node with an enabled motor.
class CanDriveWatch {
 public:
  CanDriveWatch(const app::Gateway& gateway, CanLinkSim& link, std::size_t position, AxisNumber axis,
                const Asked& asked, Runtime& runtime, std::function<void(std::string)> violated);
  void check();
  void on_frame(bool towards_drive, const can::CanFrame& frame);
  /// Numbers seen that came by SDO, and by TPDO.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> looked_at() const { return {by_sdo_, by_tpdo_}; }

 private:
  struct Value {
    Instant at;
    std::uint16_t index;
    std::uint8_t sub;
    std::uint32_t raw;
  };
  void take_process_data(std::size_t tpdo, const can::CanFrame& frame);
  void check_values();
  void check_command(const can::CanFrame& frame);
  void check_presence();
  [[nodiscard]] bool came_by_tpdo(const drive::ObjectDef& object, const drive::ObjectState& state) const;
  [[nodiscard]] bool came_by_sdo(const drive::ObjectDef& object, const drive::ObjectState& state) const;
  [[nodiscard]] bool keeps_its_word() const;
  void look_for_doubles();
  [[nodiscard]] bool said_twice(const drive::ObjectState& state) const;
  [[nodiscard]] Duration period_of(drive::ObjectId object) const;
  [[nodiscard]] const std::deque<simulated::Transition>& transitions() const;
  [[nodiscard]] bool enabled() const;
  void violated(const std::string& what) { violated_("axis " + std::to_string(axis_) + ": " + what); }

  const app::Gateway& gateway_;
  CanLinkSim& link_;
  std::size_t position_;
  AxisNumber axis_;
  Runtime& runtime_;
  std::function<void(std::string)> violated_;
  AxisWatch watch_;
  std::vector<std::pair<std::uint64_t, Instant>> seen_;  ///< exchange and time of each object when last looked at
  std::array<std::vector<std::uint32_t>, 4> maps_;       ///< the newest mapping of each TPDO, as the node holds it
  std::vector<Value> received_;                          ///< process data since the last look
  Instant started_at_ = kLongAgo;
  Instant heard_at_ = kLongAgo;
  std::size_t looked_through_ = 0;  ///< of the frames that the gateway was given
  std::uint64_t newest_reply_ = 0;  ///< tag of its request
  Instant doubled_at_ = kLongAgo;   ///< when a reply came that had come before
  std::uint64_t by_sdo_ = 0, by_tpdo_ = 0;
};

}  // namespace axisgate::test
