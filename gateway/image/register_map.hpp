// SPDX-License-Identifier: Apache-2.0
// The register map: the one table of everything a Modbus-TCP client can read or write (design 3.1, map version 1).
// Promises that server, `axisgate map`, schemas/register-map.md and the tests all see these rows and no others.
// Never holds a value: where one comes from is named by `Source`, and the servers fetch it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gateway/image/command.hpp"
#include "gateway/image/quantity.hpp"

namespace axisgate {

inline constexpr std::uint16_t kMapVersion = 1;
inline constexpr std::uint32_t kWordOrderTest = 0x01020304;

/// Where the value of a row is found.
enum class Source : std::uint8_t {
  quantity,  ///< RegisterRow::quantity of the axis's image
  // The axis's image.
  link_state,
  age_ms,
  supported,
  valid,
  sequence,
  axis_state,
  motion_state,
  motion_id,
  axis_alarms,
  supported_commands,
  supported_modes,
  set_position_value,
  jog_velocity,
  lease_remaining_ms,
  units_numerator,
  units_denominator,
  rated_speed,
  owner_address,
  loss_stop_ms,
  // The client's own, per axis.
  command_result,
  command_detail,
  owner,
  command_id_seen,
  command,
  command_id,
  heartbeat,
  object_request,
  object_index,
  object_subindex,
  object_size,
  object_data,
  object_status,
  object_detail,
  // The gateway.
  map_version,
  axis_count,
  gateway_state,
  axes_online,
  uptime_s,
  gateway_alarms,
  role,
  gateway_heartbeat,
  word_order_test,
  // A bus.
  bus_link,
  bus_load,
  bus_cycle_ms,
  bus_queue_depth,
  bus_requests,
  bus_replies,
  bus_timeouts,
  bus_bad_frames,
  bus_late_replies,
  bus_dropped_bytes,
  bus_refused,
  bus_coalesced,
  bus_superseded,
  bus_reconnects,
  bus_echoes,
};

struct RegisterRow {
  std::uint16_t offset = 0;  ///< in its block
  std::string_view name = {};
  RegisterType type = RegisterType::u16;
  bool writable = false;
  Kind kind = Kind::code;
  std::string_view unit = {};  ///< of what is no quantity: "ms", "s"; quantities have their kind's
  Source source = Source::quantity;
  Quantity quantity = Quantity::statusword;
  Role may_write = Role::engineer;  ///< the lowest role that may (design 3.3 Roles); of writable rows
  bool zero_leaves = false;         ///< 0 is no value of it: in a block it leaves the row as it is (design 3.3 Zeros)
  std::string_view note = {};
  [[nodiscard]] int registers() const { return registers_of(type); }
};

enum class Block : std::uint8_t { gateway, axis, bus, overview };

/// The rows of one block, found by offset in constant time.
class RegisterTable {
 public:
  static constexpr std::size_t kSpan = 100;  ///< offsets of the largest block
  explicit RegisterTable(std::vector<RegisterRow> rows);
  [[nodiscard]] std::span<const RegisterRow> rows() const { return rows_; }
  /// The row of which `offset` is the only, first or second register; nullptr where none is listed.
  [[nodiscard]] const RegisterRow* covering(std::uint16_t offset) const;

 private:
  std::vector<RegisterRow> rows_;
  std::array<std::int8_t, kSpan> row_of_{};
};

[[nodiscard]] const RegisterTable& register_table(Block block);

/// Where a quantity, or what is none, stands in the axis's block.
[[nodiscard]] std::uint16_t axis_offset(Quantity quantity);
[[nodiscard]] std::uint16_t axis_offset(Source source);

inline constexpr std::uint16_t kAxisBlock = 100;  ///< block of axis n: 100 * n; its coils and inputs too
inline constexpr std::uint16_t kBusBlocks = 50000;
inline constexpr std::uint16_t kBusBlock = 100;
inline constexpr std::uint16_t kOverviewBlocks = 60000;
inline constexpr std::uint16_t kOverviewBlock = 10;

struct RegisterPlace {
  Block block = Block::gateway;
  std::uint16_t number = 0;  ///< of the axis, or of the bus from 0; whether it is configured is not looked at
  std::uint16_t offset = 0;
};
/// No value: outside every block of the flat map (65000 and above).
[[nodiscard]] std::optional<RegisterPlace> place_of(std::uint16_t address);
[[nodiscard]] std::uint16_t address_of(Block block, std::uint16_t number);

/// Coils and discrete inputs are bits at 100 * n + offset.
struct CoilRow {
  std::uint16_t offset = 0;
  std::string_view name = {};
  bool level = false;           ///< acts on both changes; else on 0 -> 1 only, and reads 0
  Command on = Command::none;   ///< what 1 asks for
  Command off = Command::none;  ///< what 0 asks for, of level coils
  std::string_view note = {};
};
struct InputRow {
  std::uint16_t offset = 0;
  std::string_view name = {};
  std::string_view note = {};
};
inline constexpr std::uint16_t kCoils = 10;
inline constexpr std::uint16_t kReservedCoilsEnd = 16;  ///< 10..15: a 0 is accepted, a 1 is no such address
[[nodiscard]] std::span<const CoilRow> coil_rows();     ///< in the order of their offsets 0..9
[[nodiscard]] std::span<const InputRow> input_rows();

/// What 1 asks for; jogging is running at a velocity for as long as the coil is held.
[[nodiscard]] bool supports(const Capabilities& axis, const CoilRow& coil);
/// A row of the axis's block: its quantity is there, or what its value is for. Rows of the gateway's own always are.
[[nodiscard]] bool supports(const Capabilities& axis, const RegisterRow& row);
/// The same of writing it.
[[nodiscard]] bool takes(const Capabilities& axis, const RegisterRow& row);

/// What `unit` columns say of a row; positions: `position_unit`, "1/10000 rev".
[[nodiscard]] std::string_view unit_of(const RegisterRow& row, std::string_view position_unit);
[[nodiscard]] std::string_view text(RegisterType type);

}  // namespace axisgate
