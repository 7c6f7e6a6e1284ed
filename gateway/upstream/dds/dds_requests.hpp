// SPDX-License-Identifier: Apache-2.0
// What DDS writers ask of axes, on its way through the command port: one reply for each sample.
// Promises that a request which was seen before is not run again, that nothing which a stop has overtaken is carried
// out after it, that results which come when the session is gone harm nobody, and that a stop is never refused for want
// of room. Never repeats anything.
#pragma once

#include <boost/noncopyable.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/core/line_bucket.hpp"
#include "gateway/upstream/dds/command_batches.hpp"
#include "gateway/upstream/dds/dds_clients.hpp"
#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/dds/namesakes.hpp"
#include "gateway/upstream/dds/reply_queue.hpp"
#include "gateway/upstream/dds/request_memory.hpp"
#include "gateway/upstream/dds/stop_order.hpp"

namespace axisgate::dds {

using UnitsOfAxes = std::map<AxisNumber, DdsUnits>;
using TellLine = std::function<void(const std::string&)>;

/// What requests of DDS writers and of ROS 2 nodes look at and go through. All of it outlives them.
struct RequestContext {
  const DdsSettings& settings;
  const UnitsOfAxes& units;
  const ProcessImage& image;
  CommandPort& commands;
  const SignsOfLife& signs;
  const Namesakes& namesakes;
  StopOrder& stop_order;
  TellLine tell;  ///< a line for the log, of what is refused

  [[nodiscard]] const DdsUnits& units_of(AxisNumber axis) const;
};

class DdsRequests : boost::noncopyable {
 public:
  /// `wake`: a reply has come that nobody waits for in this turn.
  DdsRequests(RequestContext with, DdsClients& clients, ReplyQueue& replies, std::function<void()> wake);

  void on_command(const CommandRecord& record, Instant now);
  void on_object(const ObjectRequestRecord& record, Instant now);

 private:
  struct Run;
  using Done = std::function<void(DdsRequests&, const BatchResult&)>;

  /// What counts of a request before anybody looks at what it asks.
  struct Asked {
    RequestKey key;
    std::uint8_t command = 0;                ///< of axis_command
    std::optional<std::int32_t> strength{};  ///< of its writer; none: of a topic without ownership
    bool stops = false;                      ///< it finds room where there is none
    bool lets_go = false;                    ///< neither its age nor its name counts
    bool fresh = true;                       ///< and so a sign of life
  };
  /// The result of a request that is not judged any further.
  struct NotAdmitted {
    std::uint8_t result = 0;
    std::uint32_t detail = 0;
  };
  /// Who asks, or why it ends here.
  using Admitted = std::variant<std::shared_ptr<const ClientLife>, NotAdmitted>;
  [[nodiscard]] Admitted admit(const Asked& asked, Instant now);
  /// False: another gateway's, or nobody's, and not answered. Of one that is meant for us by half, and may not be: 17.
  [[nodiscard]] bool is_for_us(const GatewayId& gateway, const Guid& writer, bool lets_go, Instant now);
  [[nodiscard]] WriteBatch new_batch(std::shared_ptr<const ClientLife> life, bool fresh, Instant now) const;
  void start(AxisNumber axis, CommandPlan plan, Done done);
  [[nodiscard]] static std::optional<BatchResult> carry_on(const std::shared_ptr<Run>& run, BatchResult last);

  void press(const CommandRecord& record, const AxisImage* axis, bool held);
  /// A stop was sent before it: the button may be held still, and then its repetitions are no press.
  void press_in_vain(const CommandRecord& record);
  void end_command(const CommandRecord& record, bool held, const BatchResult& result);
  [[nodiscard]] Outcome of_jog(const CommandRecord& record, bool held, const Outcome& outcome);
  void reply(const CommandRecord& record, std::uint8_t result, std::uint32_t detail = 0);
  void reply(const ObjectRequestRecord& record, std::uint8_t result, std::uint32_t detail);
  /// The ways in which a request ends before it comes to an axis: not admitted, and so not remembered or seen before;
  /// or admitted, and its result is remembered. `what`: for the log; empty: no line.
  template <typename Request>
  void refuse(const Request& record, std::string_view what, NotAdmitted why, Instant now);
  template <typename Request>
  void end(const Request& record, std::string_view what, Errc code, Instant now);
  template <typename Request>
  void end(const Request& record, std::string_view what, std::uint8_t result, Instant now);
  void tell_refused(const Guid& writer, AxisNumber axis, std::string_view what, std::uint8_t result, Instant now);
  void tell(const Guid& writer, const std::string& what, Instant now);

  RequestContext with_;
  DdsClients& clients_;
  ReplyQueue& replies_;
  std::function<void()> wake_;
  LineBucket refused_lines_;
  RequestMemory memory_;
  /// Callbacks hold it weakly: they may come when this is gone.
  std::shared_ptr<DdsRequests> self_{this, [](DdsRequests*) {}};
};

}  // namespace axisgate::dds
