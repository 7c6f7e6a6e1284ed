// SPDX-License-Identifier: Apache-2.0
// What the gateway's configuration would say of a line on the stage: its bus, and the resolved models of its drives.
// Promises the shipped profile of each type. Never makes a line or a wire.
#pragma once

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

[[nodiscard]] model::DriveModel model_on(const StageDrive& staged, const GatewayStage::Line& line);
[[nodiscard]] model::DriveModel model_on(const RtuStageDrive& staged, const GatewayStage::Line& line);
[[nodiscard]] model::DriveModel model_on(const CanStageDrive& staged, const GatewayStage::Line& line);
[[nodiscard]] model::DriveModel model_on(const KeyaStageDrive& staged, const GatewayStage::Line& line);

[[nodiscard]] config::BusConfig bus_on(const GatewayStage::Line& line);

}  // namespace axisgate::test
