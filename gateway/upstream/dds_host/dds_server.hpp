// SPDX-License-Identifier: Apache-2.0
// The DDS server of the gateway: axisgate-dds with its keeper, and the DDS session that it serves.
// Promises what host::Keeper promises of the process, and that a name which another gateway has is reported.
// Never sends from inside a turn of a drive: what changes there arms a timer.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"
#include "gateway/upstream/dds/dds_session.hpp"
#include "gateway/upstream/host/keeper.hpp"

namespace axisgate::dds {

/// What is reported to the gateway of the process and of the domain.
struct DdsReports {
  host::KeeperReports process;
  std::function<void(bool taken)> name_taken{};  ///< gateway alarm of that name
};

class DdsServer final : private host::HostedSession {
 public:
  /// Everything passed by reference must outlive the server.
  DdsServer(boost::asio::io_context& io, Runtime& runtime, const DdsSettings& settings, ProcessImage& image,
            const EventRing& events, CommandPort& commands, const Log& log, DdsReports reports);
  ~DdsServer() override;

  void start();
  /// The image has other axes now, with these units.
  void take_axes(const std::vector<AxisUnits>& units) { session_.take_axes(units, runtime_.now()); }
  /// As Keeper::stop().
  void stop() { keeper_.stop(); }
  [[nodiscard]] const host::Keeper& keeper() const { return keeper_; }
  /// Samples given to axisgate-dds to publish, and samples of clients taken from it, since the start.
  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t received = 0;
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] host::Heard hear(Bytes packet) override;
  void take(Instant now) override;
  [[nodiscard]] bool has_room() const override { return session_.has_room(); }
  void on_link_up(Instant now) override { session_.on_link_up(now); }
  void on_link_down(Instant now) override { session_.on_link_down(now); }
  [[nodiscard]] std::optional<std::vector<Byte>> next(Instant now) override;
  [[nodiscard]] Instant wake_at() const override { return session_.wake_at(); }
  void on_name_taken(bool taken, const std::string& where);

  Runtime& runtime_;
  const DdsSettings settings_;
  const Log& log_;
  DdsReports reports_;
  host::Keeper keeper_;
  DdsSession session_;
  Record heard_;  ///< the last one of its own
  Counts counts_;
};

}  // namespace axisgate::dds
