// SPDX-License-Identifier: Apache-2.0
// One simulated drive, or two on one line, behind the shipped core and the shipped Modbus-TCP server, in manual time; a
// PLC (a), a panel (b) and whoever set the plant up, each with an address of its own. Promises that what the motor does
// is read from the simulated drive, and that a and b have written nothing before the test does. Never decides what is
// right.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "tests/obey/client.hpp"
#include "tests/stage/subject.hpp"

namespace axisgate::test::obey {

struct PlantOptions {
  std::optional<LeaseRules> lease{};  ///< none: leases are off
  modbus_tcp::ListenerSettings listener{};
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> open_points{};  ///< drawn from this (open_points.hpp); none: as the sheets print them
  bool neighbour = false;                      ///< a second drive on the line, where one may be (subject.hpp)
  bool neighbour_first = false;                ///< which the configuration names before it
  /// `limits.velocity` of axis 1; the drive keeps its maker's speed of moves.
  std::optional<std::int64_t> velocity_limit{};
  bool other_bus = false;  ///< a line of its own beside it, with axis kAxisOfOtherBus
};
inline constexpr AxisNumber kAxisOfOtherBus = 50;
/// The same listener for whoever writes integers, whole and awaited.
[[nodiscard]] modbus_tcp::ListenerSettings plain(modbus_tcp::ListenerSettings listener);
/// Leases of 2 s, quick_stop, any request.
[[nodiscard]] inline PlantOptions with_leases(bool client_is_address = false) {
  PlantOptions options{.lease = LeaseRules{}};
  options.listener.client_is_address = client_is_address;
  return options;
}

/// What befalls the next exchanges with the drive. On CAN only those are struck that a node answers (SDO, guarding;
/// with Keya's own protocol each command), process data never.
enum class Strike : std::uint8_t {
  lose_request,  ///< the drive never sees it
  lose_reply,    ///< the drive acts
  late_reply,
  double_reply,
  // On lines that carry bytes:
  noise_before,  ///< the reply
  noise_after,
  flip_bit,  ///< of the reply
  split_reply,
  // On CAN:
  emergencies,    ///< unasked
  babble,         ///< signs of life that are none
  half_reply,     ///< Modbus RTU, as the next three
  wrong_length,   ///< with a right CRC
  wrong_station,  ///< on all but CAN's own
  glued_reply,    ///< and the one before it once more
};
inline constexpr std::array kStrikes{
    Strike::lose_request, Strike::lose_reply,   Strike::late_reply,    Strike::double_reply, Strike::noise_before,
    Strike::noise_after,  Strike::flip_bit,     Strike::split_reply,   Strike::emergencies,  Strike::babble,
    Strike::half_reply,   Strike::wrong_length, Strike::wrong_station, Strike::glued_reply};

class Plant {
 public:
  explicit Plant(Subject subject, PlantOptions options = {});
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// Online, with speeds and ramps that suit a test, and enabled by neither a nor b; with leases nobody owns it then.
  void ready();
  /// The same, disabled.
  void ready_but_disabled();

  void run(Duration time) { stage.run(time); }
  /// Sends the same request for so long, each 50 ms. The answers are not looked at.
  void scan(Client& client, const Write& request, Duration time);

  // What it can suffer (outage.cpp). Each returns at once; time passes only by run() and by waiting for answers.
  /// The port or the adapter is gone, and the system says so; and back.
  /// `bus_off`: on CAN the controller has left the bus instead.
  void unplug(bool bus_off = false);
  void plug();
  /// Nothing that is sent arrives on the other side, and nobody says so.
  /// `drive_alone`: between the line and axis 1's drive, where that has a neighbour.
  void cut_wire(bool drive_alone = false);
  void mend_wire();
  /// False: on such a line it cannot strike.
  bool strike(Strike how, std::uint64_t times = 1, Duration late_by = std::chrono::milliseconds(300));
  /// From now on it strikes each reply with this probability; 0: no more. False: on such a line it cannot strike.
  bool strike_often(Strike how, double probability, Duration late_by = std::chrono::milliseconds(300));
  /// So often it has struck.
  [[nodiscard]] std::uint64_t struck(Strike how);
  /// The drive loses its power, for so long.
  void restart_drive(Duration off = {});
  /// A fault whose cause is gone already.
  void trip_drive();
  /// Somebody enables the drive at its keypad as soon as it does not watch the gateway any more. On CANopen.
  bool is_enabled_by_hand_once_disarmed();
  /// A frame of another master on the CAN bus, with a standard identifier and at most 8 bytes.
  void other_master_sends(std::uint32_t id, const std::vector<std::uint8_t>& bytes);
  /// The gateway's process dies: nothing more is sent, all connections are gone. Cables, drives and motor live on.
  void crash_gateway();
  /// It will die while it sends: so many bytes from now on, on CAN frames, still leave it. crash_gateway() buries it.
  void die_after(std::size_t units);
  [[nodiscard]] bool dead();
  /// A new one with the same configuration. a, b and whoever else wants it must connect() anew.
  void start_gateway();
  /// Frames that the gateway has put on the wire, or tried to, since the beginning.
  [[nodiscard]] std::size_t frames_sent();
  /// Requests that reached the drive; process data does not count.
  [[nodiscard]] std::uint64_t requests_heard();
  /// Each Modbus request and answer of all clients.
  void on_modbus(std::function<void(bool to_gateway, Bytes adu)> on_adu) { port_.on_modbus = std::move(on_adu); }
  /// Some of what strike() announced has not befallen anything yet.
  [[nodiscard]] bool still_strikes(Strike how);

  // What the motor does.
  [[nodiscard]] Truth motor() { return truth(stage, subject); }
  [[nodiscard]] std::int64_t position() { return motor().position; }
  [[nodiscard]] std::int64_t velocity() { return motor().velocity; }
  /// Of an iD286pro, whose bus cannot disable it, the gateway's gate.
  [[nodiscard]] bool enabled();
  [[nodiscard]] bool stands();  ///< and has for 100 ms
  /// Waits until it stands, then tells where. `limit`: of the wait.
  std::int64_t comes_to_rest_at(Duration limit = std::chrono::seconds(30));
  /// Waits until it has this speed, within one part in fifty.
  bool reaches(std::int64_t velocity, Duration limit = std::chrono::seconds(5));
  [[nodiscard]] bool turns_within(Duration limit);
  /// It turns now, and still does a second later.
  [[nodiscard]] bool keeps_turning();
  [[nodiscard]] bool comes_to_stand(Duration limit = std::chrono::seconds(3));
  [[nodiscard]] bool logged(const std::string& part);

  // A motion without an end of its own in the time of a test: a speed, or a very far target where the drive has none.
  [[nodiscard]] std::int64_t endless_command() const { return has_speeds(subject) ? 8 : 6; }
  [[nodiscard]] Rows endless_target() const;
  Answer set_endless(Client& client);
  /// Its target, its command, and it turns.
  bool start_endless(Client& client);
  /// The rows 48 to 52 that the drive has and ready() set: for blocks that cover them.
  [[nodiscard]] Rows profile_rows();

  Subject subject;
  GatewayStage stage;
  modbus_tcp::ListenerSettings listener;

 private:
  void open_port();
  void join_wire();

  Log log_;
  std::optional<modbus_tcp::ClientRegistry> registry_;
  ServedPort port_;
  bool neighbour_;
  bool makers_speed_;
  bool wire_cut_ = false;
  bool drive_cut_ = false;
  bool drive_off_ = false;
  std::unique_ptr<Timer> power_back_;
  Client fitter_;

 public:
  Client a;
  Client b;
  /// Another connection, from the address whose last byte is `host`; through a listener of its own if one is given.
  [[nodiscard]] std::unique_ptr<Client> connection_from(std::uint8_t host,
                                                        std::optional<modbus_tcp::ListenerSettings> its = {}) {
    return std::make_unique<Client>(port_, stage.runtime(), host, std::move(its));
  }
  [[nodiscard]] bool has(unsigned bit) {
    return (static_cast<std::uint32_t>(fitter_.wide(shown::supported)) >> bit & 1U) != 0;
  }
  static constexpr std::uint8_t kHostOfA = 10, kHostOfB = 20, kHostOfFitter = 30;
};

/// Far enough to take a second or more, at the speed that ready() sets.
inline constexpr std::int64_t kFar = 150'000, kNear = 20'000, kAway = -60'000;
inline constexpr std::int64_t kEndless = 20'000'000;
inline constexpr std::int64_t kSpeed = 150'000, kOtherSpeed = -90'000;

}  // namespace axisgate::test::obey
