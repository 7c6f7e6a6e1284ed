// SPDX-License-Identifier: Apache-2.0
// The gateway: all buses, drives and axes of a configuration, one image and one command port over them.
// Promises that it is the same object in the product and in the simulation: what differs (clock, wires) is handed in;
// that a reload touches no bus that stays as it is. Never opens a device or a socket itself, and never enables anything
// at start.
#pragma once

#include <bitset>
#include <functional>
#include <memory>
#include <vector>

#include "gateway/compose/bus_line.hpp"
#include "gateway/compose/bus_release.hpp"
#include "gateway/compose/reload_plan.hpp"
#include "gateway/config/config.hpp"
#include "gateway/drive/device/drive.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"

namespace axisgate::compose {

/// Per bus, per drive, in configuration order.
using Models = std::vector<std::vector<model::DriveModel>>;
/// The end on purpose takes at most so long, whatever the buses do.
inline constexpr Duration kClosing = std::chrono::seconds(3);

/// An event loop turn this late raises the gateway alarm "event loop slow".
inline constexpr Duration kSlowLoop = std::chrono::milliseconds(50);

class Gateway final : public CommandPort {
 public:
  /// `config` and `models` were checked together (config_loader).
  Gateway(const config::Config& config, const Models& models, Runtime& runtime, const Log& log, MakeWire make_wire);
  ~Gateway() override;

  /// Opens the wires. A device that is missing is picked up when it appears.
  void start();
  /// The end on purpose: from now on only stops are accepted; what waits ends as never started, what is on a wire is
  /// awaited. A drive that watches for a dead gateway, and of which a read shows that no motor has torque, is set not
  /// to; every other one keeps what it does, and will miss the gateway (SECURITY.md). `closed` is called once, after
  /// kClosing at the latest.
  void close(std::function<void()> closed);
  /// Goes on with another configuration: buses that `plan` keeps are untouched, the others end, and those of `wanted`
  /// that are new begin. All of it or nothing: `done` is called once, in a turn of its own, with the reasons why
  /// nothing was done. `last_word` is asked when the buses are to be released, and may still give such reasons.
  /// One at a time; not while the gateway ends. When the gateway ends meanwhile, nothing is done.
  void reload(const ReloadPlan& plan, config::Config wanted, Models models,
              std::function<std::vector<std::string>()> last_word,
              std::function<void(std::vector<std::string> why_not)> done);
  [[nodiscard]] bool reloads() const { return bus_release_ != nullptr; }
  [[nodiscard]] bool ends() const { return stopping_; }
  /// The last word before everything is taken apart: nothing is sent any more, whoever goes.
  void stop();

  [[nodiscard]] std::optional<BatchResult> submit(AxisNumber axis, const WriteBatch& batch,
                                                  BatchCallback on_result) override;
  void client_gone(ClientId client) override;
  [[nodiscard]] bool holds(AxisNumber axis, Quantity quantity, std::int64_t value) const override;
  [[nodiscard]] bool owner_asks(AxisNumber axis, ClientId client, Quantity quantity, std::int64_t value) const override;
  [[nodiscard]] std::int32_t set_position_value(AxisNumber axis) const override;

  [[nodiscard]] ProcessImage& image() { return image_; }
  [[nodiscard]] const EventRing& events() const { return events_; }
  [[nodiscard]] bus::Bus& bus(std::size_t index) { return buses_[index]->bus(); }
  [[nodiscard]] std::size_t bus_count() const { return buses_.size(); }
  [[nodiscard]] const drive::Drive* drive_of(AxisNumber axis) const;
  /// No bus has waited longer than `slack` for its turn of the loop.
  [[nodiscard]] bool all_turn(Duration slack) const;
  /// The loop was this late once (the shell measures it).
  void report_loop_delay(Duration delay);
  /// The DDS server is configured and its process does not run: gateway alarm "DDS process down".
  void report_dds_down(bool down) { dds_down_ = down; }
  /// Another gateway of the DDS domain has our name: gateway alarm "name taken".
  void report_name_taken(bool taken) { name_taken_ = taken; }
  /// An address that is to be served is not there: gateway alarm "listener down".
  enum class Served : std::uint8_t { modbus_tcp, dds, web };
  void report_address_missing(Served by, bool missing) { missing_.set(static_cast<std::size_t>(by), missing); }
  /// A file that the gateway was started with is not what it runs with any more; empty: all are again.
  void report_file_changed(const std::string& file);
  /// An event of the gateway itself, and so a line of the log. `asked_for`: by a person, as a reload is.
  void report(EventKind kind, std::string text, bool asked_for = false) {
    events_.add(runtime_.now(), 0, kind, 0, std::move(text), asked_for);
  }

 private:
  struct Place {
    drive::Drive* drive = nullptr;
    AxisSlot slot = 0;
  };
  void drive_closed();
  [[nodiscard]] std::unique_ptr<BusLine> make_bus(const config::BusConfig& config,
                                                  const std::vector<model::DriveModel>& models, std::size_t place);
  void find_places();
  void replace(const ReloadPlan& plan, const config::Config& wanted, const Models& models);
  void refresh();
  [[nodiscard]] std::uint16_t gateway_alarms() const;

  Runtime& runtime_;
  const Log& log_;
  const MakeWire make_wire_;
  ProcessImage image_;
  EventRing events_;
  std::vector<std::unique_ptr<BusLine>> buses_;
  std::array<Place, kMaxAxisNumber + 1> places_{};
  Instant started_ = kLongAgo;
  Instant slow_loop_at_ = kLongAgo;
  bool stopping_ = false;
  bool stopped_ = false;
  std::size_t open_drives_ = 0;
  std::function<void()> closed_{};
  std::unique_ptr<Timer> closing_;
  std::unique_ptr<BusRelease> bus_release_;
  std::unique_ptr<Timer> bus_release_ended_;  ///< takes bus_release_ away in a turn of its own
  bool dds_down_ = false;
  bool name_taken_ = false;
  std::bitset<3> missing_;  ///< by Served: an address
  bool file_changed_ = false;
};

}  // namespace axisgate::compose
