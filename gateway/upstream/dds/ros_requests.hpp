// SPDX-License-Identifier: Apache-2.0
// What ROS 2 nodes ask of axes by topics: joint_commands for all of them, and enable, quick_stop, fault_reset and home
// of each (design 4). Promises that each axis has one client for all nodes, whose lease a sample that names a target
// for the axis renews, so that silence ends it; that while a stream's motion is on, a sample which does not act renews
// nothing; that a sample which cannot be meant as it stands is refused whole; that nothing but the topic enable
// enables. Never replies: what is refused is an event or a line of the log.
#pragma once

#include <boost/noncopyable.hpp>
#include <map>
#include <memory>
#include <string>

#include "gateway/core/line_bucket.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/dds/dds_requests.hpp"
#include "gateway/upstream/dds/identities.hpp"
#include "gateway/upstream/dds/joint_stream.hpp"
#include "gateway/upstream/dds/namesakes.hpp"
#include "gateway/upstream/dds/signs_of_life.hpp"
#include "gateway/upstream/dds/stop_order.hpp"

namespace axisgate::dds {

/// Ids of these clients: above those of Modbus clients and of DDS writers.
inline constexpr ClientId kFirstRosClient = kFirstDdsClient + (ClientId{1} << 62U);

/// Complaints that are remembered, so that a stream does not fill the log with one of them.
inline constexpr std::size_t kMaxComplaints = 64;

class RosRequests : boost::noncopyable {
 public:
  RosRequests(RequestContext with, const Identities& identities) : with_(std::move(with)), identities_(identities) {}

  void on_joint_commands(const JointCommandsRecord& record, Instant now);
  void on_action(const RosActionRecord& record, Instant now);
  /// Nobody can hear these clients for as long as axisgate-dds is away: their leases get their grace.
  void on_link_down(Instant now);

 private:
  struct Joint {
    std::shared_ptr<ClientLife> life{};
    JointStream stream{};
    Instant newest = kLongAgo;    ///< when the newest sample for this axis came, renewing or not
    Instant followed = kLongAgo;  ///< when the newest one of a stream that moves it came
  };
  [[nodiscard]] Joint& joint_of(AxisNumber axis);
  [[nodiscard]] JointView view_of(const AxisImage& axis, const Joint& joint) const;
  [[nodiscard]] std::map<std::string_view, const AxisImage*> axes_by_name() const;
  [[nodiscard]] WriteBatch new_batch(const Joint& joint, bool renews) const;
  void heard(const AxisImage& axis, Joint& joint, Instant then);
  void take_target(const AxisImage& axis, double position, double velocity, const JointCommandsRecord& from,
                   Instant now);
  void ask(AxisNumber axis, std::optional<JointTarget> target);
  [[nodiscard]] std::optional<JointTarget> take_result(const AxisImage& axis, Errc code);
  void refuse_start(const AxisImage& axis, Joint& joint);
  void halt(AxisNumber axis, const Joint& joint);
  void home(AxisNumber axis, Joint& joint, Instant now);
  [[nodiscard]] WriteBatch batch_of(const AxisImage& axis, const Joint& joint, const JointTarget& target) const;
  /// What its axis says of it is an event.
  void submit_alone(AxisNumber axis, const WriteBatch& batch);
  /// The same complaint again and again is one line a minute.
  void complain(const std::string& line, Instant now);

  RequestContext with_;
  const Identities& identities_;
  LineBucket lines_;
  std::map<std::string, Instant> complaints_;  ///< when each was logged last; at most kMaxComplaints
  std::map<AxisNumber, Joint> joints_;
  /// Callbacks hold it weakly: they may come when this is gone.
  std::shared_ptr<RosRequests> self_{this, [](RosRequests*) {}};
};

}  // namespace axisgate::dds
