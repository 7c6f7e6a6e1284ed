// SPDX-License-Identifier: Apache-2.0
// The sections of a configuration file, each read and checked by a function of its own; config_loader calls them in
// order. Promises that each finds every mistake of its section and reads on after it. Never looks at a section that is
// not its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/config/config.hpp"
#include "gateway/config/config_fault.hpp"
#include "gateway/model/model.hpp"
#include "gateway/profile/json/json_node.hpp"

namespace axisgate::config {

using profile::JsonNode;

/// none: no role has this name.
[[nodiscard]] Role role_named(std::string_view name);
[[nodiscard]] std::vector<modbus_tcp::ListenerSettings> read_listeners(const JsonNode& root, ConfigFaults& faults);
[[nodiscard]] std::vector<BusConfig> read_buses(const JsonNode& root, ConfigFaults& faults);
[[nodiscard]] DriveConfig read_drive(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults);
[[nodiscard]] AxisConfig read_axis(const JsonNode& node, ConfigFaults& faults);
/// The section "dds", with the units of all axes.
[[nodiscard]] std::optional<dds::DdsSettings> read_dds(const JsonNode& root, const std::vector<BusConfig>& buses,
                                                       ConfigFaults& faults);
/// The section "web". `config`: its listeners and buses, which were read before.
[[nodiscard]] std::optional<web::WebSettings> read_web(const JsonNode& root, const Config& config,
                                                       ConfigFaults& faults);
/// What axisgate-dds reads when it starts, but the private key.
[[nodiscard]] std::vector<profile::FileRead> read_files_of_dds(const dds::DdsSettings& settings);
/// An axis's keys "dds_unit" and "metres_per_rev"; no value: rad.
[[nodiscard]] std::optional<Rational> read_metres_per_rev(const JsonNode& axis, ConfigFaults& faults);

/// Names, numbers, devices and stations that may be there once only, over the whole file.
void check_unique(const Config& config, ConfigFaults& faults);

/// The profiles of all drives, resolved for their axes; what was read for it is added to the configuration. Drives with
/// mistakes of their own are left out.
[[nodiscard]] std::vector<std::vector<model::DriveModel>> load_models(Config& config,
                                                                      const std::vector<std::string>& profile_folders,
                                                                      OpenAsks open_asks, ConfigFaults& faults);

/// A timeout that nobody has given is what the longest exchange and the slowest drive need; one that is given must be
/// longer than the exchange. `takes`: what `on_wire` is the time of, for the message.
void settle_timeout(BusConfig& bus, const std::vector<model::DriveModel>& drives, Duration on_wire,
                    const std::string& takes, ConfigFaults& faults);
/// Poll periods that nobody has given are what the line carries.
void settle_poll(BusConfig& bus, std::vector<model::DriveModel>& drives);
/// modbus-rtu: timeouts and poll periods that nobody has given follow from the drives on the line.
void settle_rtu_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults);

/// What a bus on CAN may not have, and what its device must be.
void check_can_bus(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults);
/// canopen: the same for timeouts and periods; and inhibit and confirmation times that leave the line to requests,
/// however many drives share it.
void settle_can_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults);

/// Keya's protocols: rates as the drives leave their factory.
void default_keya_bus(BusConfig& bus);
/// The silence that is kept between two frames of its serial protocols where the configuration names none.
[[nodiscard]] Duration keya_gap(std::uint32_t baud);
/// Rates, parity and number of drives of a bus that speaks one of Keya's protocols.
void check_keya_bus(const JsonNode& node, const BusConfig& bus, ConfigFaults& faults);
/// Keya's protocols: the same for timeouts and periods.
void settle_keya_buses(Config& config, std::vector<std::vector<model::DriveModel>>& models, ConfigFaults& faults);

}  // namespace axisgate::config
