// SPDX-License-Identifier: Apache-2.0
// What the gateway holds of each drive on the line, against what that drive has sent. Watches that a stored value is
// what the drive sent in answer to the very request that asked, or unasked; that nothing is valid that is stale, of
// before a restart, or of a drive that is not there. Promises to name the first violation. Never changes anything it
// looks at.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/judged/cable_words.hpp"
#include "tests/obey/plant.hpp"
#include "tests/stage_drive/rtu_truth.hpp"

namespace axisgate::test::judged {

class StoredWatch {
 public:
  using Violated = std::function<void(std::string)>;
  StoredWatch(obey::Plant& plant, Violated violated) : plant_(plant), violated_(std::move(violated)) {}

  void on_frame(const CableFrame& frame);
  /// After each step of the run. `twice`: a drive may have said something twice, and nothing in a reply tells whether
  /// it is the second one to the request before.
  void look(bool twice);
  /// Another gateway holds nothing yet.
  void gateway_died() { drives_.clear(); }

 private:
  using Entry = std::pair<std::uint64_t, Instant>;
  /// One value of a process data frame, or of a Keya's heartbeat.
  struct Value {
    Instant at;
    ObjectAddress place;
    std::uint32_t raw;
  };
  struct Watched {
    const drive::Drive* drive = nullptr;
    std::vector<AxisNumber> axes{};
    std::vector<Entry> seen{};  ///< exchange and time of each object when it was last looked at
    std::unique_ptr<RtuTruth> truth{};
    std::array<std::vector<std::uint32_t>, 4> maps{};  ///< the newest mapping of each TPDO, as the node holds it
    std::vector<Value> received{};                     ///< unasked, since the last look
    Instant started_at = axisgate::kLongAgo;
    Instant heard_at = axisgate::kLongAgo;
  };
  void begin();
  static void take_as_seen(Watched& watched);
  void take_heartbeat(const can::CanFrame& frame);
  void take_process_data(std::size_t position, std::size_t tpdo, const can::CanFrame& frame);
  void check_values(Watched& watched);
  void check_axis(Watched& watched, const model::AxisModel& axis);
  [[nodiscard]] bool was_sent(Watched& watched, const model::ObjectDef& object, const drive::ObjectState& state);
  [[nodiscard]] bool keeps_its_word(const model::DriveModel& model);
  [[nodiscard]] Duration stale_after(const Watched& watched, const model::AxisModel& axis,
                                     const model::Binding& binding) const;
  [[nodiscard]] Duration period(const drive::Drive& drive, model::ObjectId object) const;
  void violated(const std::string& what) { violated_(what); }

  obey::Plant& plant_;
  Violated violated_;
  std::vector<Watched> drives_;
};

}  // namespace axisgate::test::judged
