// SPDX-License-Identifier: Apache-2.0
// The shipped gateway core on a stage: manual time, simulated lines of every kind, shipped profiles; a client speaks
// to the command port. Promises that nothing happens but by the clock that the test moves. Never opens a device or a
// socket.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/compose/gateway.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/stage/byte_link_sim.hpp"
#include "tests/stage/can_link_sim.hpp"
#include "tests/stage/rtu_link_sim.hpp"

namespace axisgate::test {

/// One drive of a line: what it is, and what the configuration says of its axis.
struct StageDrive {
  simulated::DriveOptions options{};
  profile::ResolveAxis axis{};
  std::map<std::string, Rational> constants{};  ///< beside those every test needs (Ipeak)
};

/// The same on a Modbus RTU line.
struct RtuStageDrive {
  simulated::RtuDriveOptions options{};
  profile::ResolveAxis axis{};
  std::map<std::string, Rational> constants{};  ///< beside those every test needs (Ipeak)
  /// A file of the source folder, or the whole path of a test's own; empty: the shipped one of its type.
  std::string profile{};
  std::optional<profile::ResolveAxis> axis_b{};  ///< of a ZLAC8015D: its right motor
};

/// The same on a CAN bus.
struct CanStageDrive {
  simulated::CanDriveOptions options{};
  profile::ResolveAxis axis{};
  std::map<std::string, Rational> constants{};  ///< beside those every test needs (Ipeak)
  /// 1018h as the configuration would have it: vendor, product, revision, serial.
  std::array<std::optional<std::uint32_t>, 4> identity{};
  std::optional<profile::ResolveAxis> axis_b{};   ///< of a Keya: its motor B; none: that motor is nobody's axis
  std::string profile{};                          ///< the same
  std::optional<std::uint8_t> configured_node{};  ///< what the configuration has instead of its node number
};

/// A Keya on RS232 or RS485.
struct KeyaStageDrive {
  simulated::KeyaOptions options{};
  profile::ResolveAxis axis{};  ///< motor A
  std::map<std::string, Rational> constants{};
  std::optional<profile::ResolveAxis> axis_b{};  ///< none: motor B is nobody's axis
};

class GatewayStage {
 public:
  struct Line {
    std::string name;
    std::vector<StageDrive> drives;
    simulated::LineOptions options{};
    std::optional<std::array<Duration, 3>> poll{};  ///< fast, normal, slow; none: the defaults
    /// Any here makes it a Modbus RTU line, and `drives` and `options` do not count.
    std::vector<RtuStageDrive> rtu_drives{};
    simulated::RtuLineOptions rtu_options{};
    /// Any here makes it a CAN bus.
    std::vector<CanStageDrive> can_drives{};
    simulated::CanLineOptions can_options{};
    std::optional<Duration> timeout{};  ///< none: 100 ms; on Modbus RTU and Keya's lines what the product takes
    /// Any here makes it a line with Keya's serial protocol of `keya_options.wiring`.
    std::vector<KeyaStageDrive> keya_drives{};
    simulated::KeyaLineOptions keya_options{};
    /// Of all axes of the line. None: leases are off, as tests that speak of no owner need it; what the axes' own
    /// configuration says of a lease does not count.
    std::optional<LeaseRules> lease{};
    bool last_first = false;  ///< the configuration names its drives from the last one on
  };
  explicit GatewayStage(std::vector<Line> lines, std::uint64_t seed = 1);
  /// Whatever a test is about: a write that the way out has to hold back fails it.
  ~GatewayStage() { expect_nothing_held_back(); }
  GatewayStage(const GatewayStage&) = delete;
  GatewayStage& operator=(const GatewayStage&) = delete;

  /// Throws while none runs, as axis() and what asks the gateway do.
  [[nodiscard]] compose::Gateway& gateway();
  /// Its process dies: nothing more is sent. Cables and drives live on. Sessions on it must end inside `others`, after
  /// the last frame and before the core is gone.
  void crash(const std::function<void()>& others = [] {});
  /// A new one, with the same configuration, on the same cables.
  void start();
  /// It goes on with what `change` makes of its configuration; the models follow where a bus is taken out or put back.
  /// The result appears in the returned place: reasons why not, or none.
  using Reasons = std::vector<std::string>;
  std::shared_ptr<std::optional<Reasons>> begin_reload(
      const std::function<void(config::Config&)>& change,
      std::function<Reasons()> last_word = [] { return Reasons{}; });
  [[nodiscard]] bool gateway_runs() const { return gateway_ != nullptr; }
  [[nodiscard]] ManualRuntime& runtime() { return runtime_; }
  [[nodiscard]] SimLink& link(std::size_t line) { return *links_.at(line).kinco; }
  [[nodiscard]] RtuLinkSim& rtu_link(std::size_t line) { return *links_.at(line).rtu; }
  [[nodiscard]] CanLinkSim& can_link(std::size_t line) { return *links_.at(line).can; }
  [[nodiscard]] KeyaLinkSim& keya_link(std::size_t line) { return *links_.at(line).keya; }
  /// What `act` gives for the link of this line, of whichever kind.
  template <class Act>
  auto at_link(std::size_t line, const Act& act) {
    const LinkOfLine& link = links_.at(line);
    if (link.kinco) return act(*link.kinco);
    if (link.rtu) return act(*link.rtu);
    if (link.can) return act(*link.can);
    return act(*link.keya);
  }
  /// Brought up to now. The drive there must be of this kind, on whichever line.
  [[nodiscard]] simulated::KincoDrive& drive(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::Id286pro& id286pro(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::Em2rs& em2rs(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::Zlac8015d& zlac8015d(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::LeadshineDrive& leadshine(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::EdsDrive& eds_drive(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::KeyaDrive& keya(std::size_t line, std::size_t position = 0);
  [[nodiscard]] simulated::CanopenNode& can_node(std::size_t line, std::size_t position = 0);
  [[nodiscard]] const AxisImage& axis(AxisNumber number) { return *gateway().image().find(number); }
  [[nodiscard]] std::vector<std::string>& log() { return log_lines_; }
  /// Who spoke in each line that was ever written.
  [[nodiscard]] const std::vector<LogSource>& log_sources() const { return log_sources_; }

  void run(Duration time) { runtime_.advance_by(time); }
  /// Runs until `done` or for at most `limit`; false: it did not come true.
  bool run_until(const std::function<bool()>& done, Duration limit = std::chrono::seconds(20));
  /// Runs until all axes are online.
  bool come_online() {
    return run_until([this] {
      for (const auto& a : gateway().image().axes())
        if (a->link_state != LinkState::online) return false;
      return true;
    });
  }

  /// Submits and runs until the result is there.
  BatchResult ask(AxisNumber axis, WriteBatch batch);
  BatchResult command(AxisNumber axis, Command command);
  BatchResult write(AxisNumber axis, Quantity quantity, std::int64_t value);
  /// Submits without waiting; the result appears in the returned place.
  std::shared_ptr<std::optional<BatchResult>> begin(AxisNumber axis, WriteBatch batch);

 private:
  void expect_nothing_held_back() const;
  ManualRuntime runtime_;
  std::vector<std::string> log_lines_;
  std::vector<LogSource> log_sources_;
  Log log_;
  /// One of them.
  struct LinkOfLine {
    std::unique_ptr<SimLink> kinco;
    std::unique_ptr<RtuLinkSim> rtu;
    std::unique_ptr<CanLinkSim> can;
    std::unique_ptr<KeyaLinkSim> keya;
  };
  [[nodiscard]] LinkOfLine link_of(const Line& line, std::uint64_t seed);
  [[nodiscard]] std::unique_ptr<bus::Wire> wire_on(const config::BusConfig& bus,
                                                   const std::vector<model::DriveModel>& drives);
  const std::vector<Line> lines_;
  std::vector<LinkOfLine> links_;
  config::Config config_;  ///< of the gateway that runs
  std::unique_ptr<compose::Gateway> gateway_;
};

/// A commissioned drive on a line of its own.
[[nodiscard]] GatewayStage::Line line_of(simulated::KincoType type, AxisNumber axis);
/// Commissioned drives on one Modbus RTU line, with axes from `first` on; a ZLAC8015D has two.
[[nodiscard]] GatewayStage::Line rtu_line_of(std::vector<simulated::RtuDriveOptions> drives, AxisNumber first);
/// Keya drives on RS232 (one) or RS485, motors A and B being axes from `first` on.
[[nodiscard]] GatewayStage::Line keya_line_of(simulated::KeyaWiring wiring, std::vector<simulated::KeyaOptions> drives,
                                              AxisNumber first);
/// Commissioned drives on one CAN bus, with axes from `first` on; a Keya has two. Keya's own protocol is for a bus
/// where all drives speak it.
[[nodiscard]] GatewayStage::Line can_line_of(std::vector<simulated::CanDriveOptions> drives, AxisNumber first);

}  // namespace axisgate::test
