// SPDX-License-Identifier: Apache-2.0
// A DDS program of somebody else, on the loopback alone: readers and writers of any topic of ours.
#pragma once

#include <axisgate.h>
#include <ros2_msgs.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tests/dds_peers/raw_type.hpp"
#include "tests/dds_process/child.hpp"

namespace axisgate::dds::test {

struct ReaderSettings {
  bool transient_local = false;
  bool exclusive = false;
  int depth = 1;  ///< 0: keep all
};

enum class Liveliness : std::uint8_t { automatic, manual_by_participant, manual_by_topic };

struct WriterSettings {
  std::uint32_t strength = 0;
  bool exclusive = true;
  Liveliness liveliness = Liveliness::automatic;
  std::chrono::milliseconds lease{0};  ///< 0: endless
  /// Off for a writer that is deleted while much of it is unacknowledged: Fast DDS 2.9.1 can run for ever in a
  /// heartbeat then (StatefulWriter::add_gaps_for_holes_in_history_). Samples carry heartbeats of their own.
  bool heartbeats = true;
  bool transient_local = false;
};

template <typename Sample>
class Reader {
 public:
  virtual ~Reader() = default;
  /// None in that time.
  virtual std::optional<Sample> next_within(std::chrono::milliseconds time) = 0;
  /// None within the test's patience.
  std::optional<Sample> next() { return next_within(kPatience); }
  [[nodiscard]] virtual bool matched() = 0;
};

template <typename Sample>
class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(Sample sample) = 0;
  /// False: none within the test's patience.
  virtual bool wait_matched() = 0;
  [[nodiscard]] virtual bool matched() = 0;
  virtual void assert_liveliness() = 0;
  [[nodiscard]] virtual Guid guid() const = 0;
};

/// One participant. Readers and writers end before it.
class Peer {
 public:
  explicit Peer(std::uint32_t domain = test_domain());
  ~Peer();
  template <typename Sample>
  std::unique_ptr<Reader<Sample>> reader(const std::string& topic, const ReaderSettings& settings);
  template <typename Sample>
  std::unique_ptr<Writer<Sample>> writer(const std::string& topic, const WriterSettings& settings = {});

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

inline constexpr const char* kCommands = "axisgate/axis_command";
inline constexpr const char* kObjects = "axisgate/object_request";

[[nodiscard]] AxisCommand command(std::uint16_t axis, std::uint64_t request_id);
/// The next command of this writer.
[[nodiscard]] std::optional<CommandRecord> command_of(Child& child, const Guid& writer);

}  // namespace axisgate::dds::test
