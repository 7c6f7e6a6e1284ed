// SPDX-License-Identifier: Apache-2.0
// The DDS server before the shipped core with simulated drives: DDS writers ask, Modbus clients beside them, and motors
// turn or stand. Promises that the session is read when it asks to be, and never besides, as its host would; and that a
// request whose reply does not come, or comes twice, fails the test. Never decides what is right.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/stage/gateway_stage.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::test {

/// A CiA 402 servo (Kinco JD by its own protocol), and a virtual axis (iD286pro on Modbus RTU).
inline constexpr AxisNumber kServo = 1, kStepper = 2;
/// Of command_result.
inline constexpr int kDone = 2, kRefused = 3, kNotOwner = 7, kUnsuitable = 9, kNotSupported = 16, kBadValue = 17;

struct DdsRigOptions {
  LeaseRules lease{};
  dds::DdsSettings settings{};
  std::optional<Range> position_limits{};  ///< of the servo
};

class DdsRig {
 public:
  explicit DdsRig(DdsRigOptions options = {});

  GatewayStage stage;

  /// A writer of axis_command that has stated a lease: axisgate-dds says each 200 ms that it lives, until die() or
  /// fall_silent().
  dds::Guid writer(std::uint8_t participant, std::uint8_t entity = 1, std::int32_t strength = 0);
  /// Its liveliness is lost: axisgate-dds says so.
  void die(const dds::Guid& writer);
  /// Nobody says anything of it any more.
  void fall_silent(const dds::Guid& writer) { std::erase(beating_, writer); }

  /// With a new id: sends it and waits for its one reply.
  dds::ReplyRecord ask(dds::CommandRecord record);
  dds::ReplyRecord ask(const dds::Guid& writer, std::uint8_t command, AxisNumber axis = kServo);
  /// Runs at this many turns a second.
  dds::ReplyRecord run_at(const dds::Guid& writer, double turns_per_s, AxisNumber axis = kServo);
  dds::ObjectReplyRecord ask(dds::ObjectRequestRecord record);
  /// Without waiting; its id.
  std::uint64_t send(dds::CommandRecord record);
  void send_again(dds::CommandRecord record, std::uint64_t id);
  /// A record of axisgate-dds that has no reply.
  void give(const dds::Record& record);
  [[nodiscard]] std::size_t replies(std::uint64_t id) const;

  void link_down();
  void link_up();

  /// A reload has taken this axis away.
  void take_away(AxisNumber axis) {
    stage.gateway().image().remove_axis(axis);
    session_->take_axes({}, now());
  }

  void run(Duration time);
  bool run_until(const std::function<bool()>& done, Duration limit = std::chrono::seconds(20));

  /// The newest sample of axis_state.
  [[nodiscard]] const dds::StateRecord& state(AxisNumber axis = kServo) { return states_.at(axis); }
  [[nodiscard]] bool has_event(const std::string& part) const;
  /// The motor itself, within 100 ms.
  [[nodiscard]] bool turns(AxisNumber axis = kServo);
  [[nodiscard]] const AxisImage& axis(AxisNumber number = kServo) { return stage.axis(number); }
  /// A Modbus client's request.
  Errc modbus(const std::shared_ptr<ClientLife>& client, WriteBatch batch, bool claims = true);
  [[nodiscard]] Instant now() { return stage.runtime().now(); }

  std::vector<dds::StateRecord> samples;  ///< of axis_state, all of them
  std::vector<dds::EventRecord> events;
  std::vector<dds::GatewayRecord> gateway;
  std::vector<std::string> told;  ///< lines for the log

 private:
  void read();
  [[nodiscard]] std::int64_t position(AxisNumber axis);

  bool woken_ = true;
  bool up_ = false;
  std::unique_ptr<dds::DdsSession> session_;
  std::vector<dds::Guid> beating_;
  std::map<dds::Guid, std::int32_t> strengths_;
  Instant next_beat_ = kLongAgo;
  std::uint64_t last_id_ = 0;
  std::map<AxisNumber, dds::StateRecord> states_;
  std::vector<dds::ReplyRecord> replies_;
  std::vector<dds::ObjectReplyRecord> object_replies_;
};

[[nodiscard]] dds::CommandRecord move_to(const dds::Guid& writer, double turns, AxisNumber axis = kServo);
inline constexpr double kTurn = 6.283185307179586;

}  // namespace axisgate::test
