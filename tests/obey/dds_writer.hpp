// SPDX-License-Identifier: Apache-2.0
// A DDS client of these tests: one writer of axis_command as axisgate-dds tells of it, records in memory, before the
// shipped DDS server of one gateway. Promises that a second reply to one request is an error. Never looks into the
// gateway.
#pragma once

#include <map>
#include <optional>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/model/write.hpp"
#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test::obey {

class DdsWriter {
 public:
  /// `participant`: of its GUID.
  DdsWriter(GatewayStage& stage, std::uint8_t participant);

  /// Sends a sample of axis 1 and returns its request_id at once.
  std::uint64_t begin(const model::Write& sample);
  /// command_result of its reply; none yet, or never.
  [[nodiscard]] std::optional<std::uint8_t> result_of(std::uint64_t request);
  /// The writer is deleted, and another one begins; its participant is another, too.
  void replace();

 private:
  void read();
  GatewayStage& stage_;
  std::uint8_t participant_;
  dds::DdsSession session_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::uint8_t> results_;
};

}  // namespace axisgate::test::obey
