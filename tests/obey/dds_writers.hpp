// SPDX-License-Identifier: Apache-2.0
// The DDS clients of these tests: writers of axis_command as axisgate-dds tells of them, records in memory, before the
// shipped DDS server of one gateway. Promises that a second reply to one request is an error. Never looks into the
// gateway.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/model/write.hpp"
#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test::obey {

/// "max_age_ms" of the gateway before which these writers stand.
inline constexpr Duration kMaxAge = std::chrono::milliseconds(500);

class DdsWriters {
 public:
  /// `participant`: of the first one's GUID, the others' follow. `strengths`: one for each writer; 0 of a SHARED one.
  DdsWriters(GatewayStage& stage, std::uint8_t participant, std::vector<std::int32_t> strengths = {0});

  /// Sends a sample of axis 1 and returns a number for its reply at once: its request_id, of one that repeats another
  /// more than that.
  std::uint64_t begin(const reference::Write& sample, std::size_t writer = 0);
  /// What this writer has asked for so many requests ago, 1 or more, to be said once more; flawed ones do not count.
  /// None: it has not asked, or has no reply to it yet.
  [[nodiscard]] std::optional<reference::Write> said(std::size_t writer, std::size_t ago);
  /// axisgate-dds dies: nothing is heard of anybody, replies are lost. It comes back, and finds the same writers.
  void process_dies();
  void process_returns();
  /// A sample for another gateway, whose name and key agree. Nobody answers it.
  void ask_another_gateway(const reference::Write& sample, std::size_t writer);
  /// command_result of its reply; none yet, or never.
  [[nodiscard]] std::optional<std::uint8_t> result_of(std::uint64_t request);
  /// The writer is deleted, or its liveliness is lost, and another one begins.
  void replace(std::size_t writer, bool of_the_same_participant);
  /// MANUAL_BY_TOPIC: its liveliness is good.
  void assert_liveliness(std::size_t writer);
  /// A sample of heartbeat, with the counter of the one before or the next one.
  void beat(std::size_t writer, bool counts_on, std::uint32_t lease_ms);
  /// One with the next counter that is too old, or of another participant.
  void beat_in_vain(std::size_t writer, bool too_old);

 private:
  struct Writer {
    dds::Guid guid{};
    std::int32_t strength = 0;
    std::uint32_t counter = 0;
    std::vector<std::pair<std::uint64_t, reference::Write>> said{};  ///< with their request_ids
  };
  [[nodiscard]] dds::CommandRecord record_of(const reference::Write& sample, const Writer& by, std::uint64_t id);
  void tell(const dds::Record& record);
  void read();
  [[nodiscard]] dds::SteadyNs now_ns();
  GatewayStage& stage_;
  std::uint8_t participant_;
  std::vector<Writer> writers_;
  dds::DdsSession session_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::vector<std::uint8_t>> results_;  ///< of a request_id
  std::map<std::uint64_t, std::size_t> asked_;                  ///< how often
};

}  // namespace axisgate::test::obey
