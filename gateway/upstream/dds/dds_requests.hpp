// What DDS writers ask of axes, on its way through the command port: one reply for each sample.
// Promises that a request which was seen before is not run again, that results which come when the face is gone harm
// nobody, and that a stop is never refused for want of room. Never repeats anything.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/core/line_bucket.hpp"
#include "gateway/upstream/dds/command_groups.hpp"
#include "gateway/upstream/dds/dds_clients.hpp"
#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/dds/reply_queue.hpp"
#include "gateway/upstream/dds/request_memory.hpp"

namespace axisgate::dds {

using UnitsOfAxes = std::map<AxisNumber, DdsUnits>;
using TellLine = std::function<void(const std::string&)>;

class DdsRequests {
 public:
  /// `wake`: a reply has come that nobody waits for in this turn. `tell`: a line for the log, of what is refused here.
  DdsRequests(const DdsSettings& settings, const UnitsOfAxes& units, const ProcessImage& image, CommandPort& commands,
              DdsClients& clients, ReplyQueue& replies, std::function<void()> wake, TellLine tell);
  DdsRequests(const DdsRequests&) = delete;
  DdsRequests& operator=(const DdsRequests&) = delete;

  void on_command(const CommandRecord& record, Instant now);
  void on_object(const ObjectRequestRecord& record, Instant now);

 private:
  struct Run;
  using Done = std::function<void(DdsRequests&, const GroupResult&)>;

  /// Who asks, or the result of a request that is not judged any further.
  using Admitted = std::variant<std::shared_ptr<const ClientLife>, std::uint8_t>;
  [[nodiscard]] Admitted admit(const RequestKey& key, bool stops, Instant now);
  [[nodiscard]] Group new_group(std::shared_ptr<const ClientLife> life, Instant now) const;
  void start(AxisNumber axis, CommandPlan plan, Done done);
  [[nodiscard]] static std::optional<GroupResult> carry_on(const std::shared_ptr<Run>& run, GroupResult last);

  void press(const CommandRecord& record, const AxisImage* axis, bool held);
  void end_command(const CommandRecord& record, bool held, const GroupResult& result);
  [[nodiscard]] Outcome of_jog(const CommandRecord& record, bool held, const Outcome& outcome);
  void reply(const CommandRecord& record, std::uint8_t result, std::uint32_t detail = 0);
  void tell_refused(const Guid& writer, AxisNumber axis, std::string_view what, std::uint8_t result, Instant now);

  const DdsSettings& settings_;
  const UnitsOfAxes& units_;
  const ProcessImage& image_;
  CommandPort& commands_;
  DdsClients& clients_;
  ReplyQueue& replies_;
  std::function<void()> wake_;
  TellLine tell_;
  LineBucket refused_lines_;
  RequestMemory memory_;
  /// Callbacks hold it weakly: they may come when this is gone.
  std::shared_ptr<DdsRequests> self_{this, [](DdsRequests*) {}};
};

}  // namespace axisgate::dds
