// SPDX-License-Identifier: Apache-2.0
// The DDS session of the gateway: what axisgate-dds is sent of the image, and what DDS clients ask of axes (design 4).
// Promises that the newest state of an axis wins where the process is slow, that every request gets exactly one reply,
// and that a DDS client is admitted, owns, leases and is refused as a Modbus client is. Never blocks, never knows a
// socket, a process or a DDS type, and never sends what it was not asked for by next().
#pragma once

#include <boost/noncopyable.hpp>
#include <memory>
#include <optional>

#include "gateway/image/command_port.hpp"
#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// Gateway state goes out this often.
inline constexpr Duration kGatewayPeriod = std::chrono::seconds(1);
/// DDS writers that are clients at a time: those that ask for something. One that has nothing makes way for another;
/// where none does, the requests of others are refused (queue_full), but not their stops.
inline constexpr std::size_t kMaxWriters = kMaxBeats;
/// What leases of DDS clients last longer once, when axisgate-dds has died (design 4).
inline constexpr Duration kGrace = std::chrono::seconds(3);
/// How long a request id is remembered; how many are: RequestBounds. Beyond, new requests are refused (queue_full).
inline constexpr Duration kRequestsKept = std::chrono::seconds(10);
/// Replies that wait for the socket.
inline constexpr std::size_t kMaxRepliesWaiting = 256;

/// What is reported to the gateway of the domain.
struct DdsDomainReports {
  /// A line for the log, of a request that is refused before it comes to an axis.
  std::function<void(const std::string&)> line{};
  /// Another gateway has our name, or has it no more: where its axis was seen, for an event.
  std::function<void(bool taken, const std::string& where)> name_taken{};
  /// A line for the log that comes once for each writer; none: `line` takes it.
  std::function<void(const std::string&)> once{};
};

class DdsSession : boost::noncopyable {
 public:
  /// A mark of image.changes calls `wake`, which arms a timer and no more. Settings stay as they
  /// are; axes and units until take_axes().
  DdsSession(DdsSettings settings, ProcessImage& image, const EventRing& events, CommandPort& commands,
             std::function<void()> wake, DdsDomainReports reports = {});
  ~DdsSession();

  /// The image has other axes now, with these units. Of an axis that is gone one more state is sent: unknown, no value.
  void take_axes(const std::vector<AxisUnits>& units, Instant now);

  /// axisgate-dds is there and knows nothing yet: states of all axes and the newest events follow.
  void on_link_up(Instant now);
  /// It is gone: nothing is to be sent, and its clients' leases get their grace.
  void on_link_down(Instant now);
  /// What it has sent. Replies may be due at once: call next().
  void on_record(const Record& record, Instant now);
  /// The reply to one more record has a place. Read nothing from the process before it has: of requests beyond that
  /// nobody is answered, and nothing in them but a stop is carried out.
  [[nodiscard]] bool has_room() const;

  /// What is to be sent now: replies before events before states. None: nothing before wake_at(), or the next wake().
  /// The record counts as sent: call it only where the socket has room, or keep the record until it has.
  [[nodiscard]] std::optional<Record> next(Instant now);
  [[nodiscard]] Instant wake_at() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace axisgate::dds
