// SPDX-License-Identifier: Apache-2.0
// One CAN bus with simulated drives of several kinds, as the host's end of the cable sees it.
// Promises arbitration: of the frames that wait, the lowest identifier goes next, and each takes its bits' time; a
// drive answers in order. Never reads a clock and never delivers a frame outside from_host() and advance().
#pragma once

#include <functional>
#include <variant>

#include "tests/simulated/drive_faults.hpp"
#include "tests/simulated/eds_drive.hpp"
#include "tests/simulated/journal.hpp"
#include "tests/simulated/keya_can.hpp"
#include "tests/simulated/keya_canopen.hpp"
#include "tests/simulated/kinco_can.hpp"
#include "tests/simulated/leadshine_drive.hpp"

namespace axisgate::simulated {

struct CanLineOptions {
  std::uint32_t bit_rate = 500000;     // 0: frames take no time
  Time reply_delay = one_millisecond;  // of an SDO or guarding request; the sheets give none
  std::size_t journal_capacity = 1000;
};

inline constexpr int highest_can_node = 127;

using CanDriveOptions = std::variant<KincoCanDrive, LeadshineOptions, KeyaCanDrive, KeyaCanopenDrive, EdsDriveOptions>;

std::string describe(const CanDriveOptions& options);  // "jd@1", "ld2@3", "keya-can@1"
std::uint8_t node_of(const CanDriveOptions& options);
// Throws std::invalid_argument for a drive that speaks no CANopen.
std::unique_ptr<CanopenNode> make_can_node(const CanDriveOptions& options);

struct CanToHost : TimedFrame {
  std::uint64_t tag = 0;     // of the request that caused it; 0: nobody asked
  std::size_t position = 0;  // of the drive that sent it
};

using CanToHostSink = std::function<void(const CanToHost&)>;  // may call from_host()

// `request` and `sent` are frames as identifier (low byte first) and data; `sent` may hold several.
using CanExchange = ExchangeOf<CanBytes>;
using CanJournal = JournalOf<CanBytes>;

class CanLine {
 public:
  CanLine(const CanLineOptions& options, Random random, CanToHostSink sink);
  CanLine(const CanLine&) = delete;
  CanLine& operator=(const CanLine&) = delete;

  // Throws std::invalid_argument for a drive that cannot have this node number. Two may have the same.
  CanNode& add(const CanDriveOptions& options);
  std::size_t size() const { return slots_.size(); }
  CanNode& any_node(std::size_t position) { return *slots_.at(position).node; }
  // Throws std::invalid_argument where the drive there speaks no CANopen.
  CanopenNode& node(std::size_t position);
  CanopenNode* canopen(std::size_t position);
  // Nothing where another kind of drive stands there.
  KincoDrive* kinco(std::size_t position);
  LeadshineDrive* leadshine(std::size_t position);
  EdsDrive* eds_drive(std::size_t position);
  KeyaDrive* keya(std::size_t position);  // in either protocol
  DriveFaults& faults(std::size_t position) { return slots_.at(position).faults; }
  bool has(DriveFault fault) const;
  void set_reply_delay(Time delay) { options_.reply_delay = delay; }
  std::uint32_t bit_rate() const { return options_.bit_rate; }
  void set_bit_rate(std::uint32_t rate) { options_.bit_rate = rate; }
  void restart(std::size_t position, Time now);  // with it go the replies it had not sent yet

  // A drive's own plug: off, it hears nothing and is not heard, and lives on.
  void connect(std::size_t position, bool connected);
  // A second drive of the same kind under the same number; it stands behind all others. Tells where.
  std::size_t add_duplicate(std::size_t position);
  // The host's controller has left the bus, or is back: no frame passes either way. The drives hear each other.
  void set_bus_off(bool off);
  bool bus_off() const { return bus_off_; }

  void from_host(const BusFrame& frame, Time now);
  void advance(Time now);
  std::optional<Time> next_event() const;
  void cut();  // the host's cable is pulled: frames under way are gone
  // An EMCY frame of this drive, now, whatever it holds.
  void send_emergency(std::size_t position, std::uint16_t code, Time now);

  // SDO and guarding requests that reached a drive.
  std::uint64_t requests_heard() const { return journal_.recorded(); }
  // SDO requests that came while a drive still owed the reply to another one, faults aside.
  std::uint64_t overlapping_requests() const { return overlapping_; }
  const CanJournal& journal() const { return journal_; }

 private:
  struct Slot {
    CanDriveOptions options;
    std::unique_ptr<CanNode> node;
    DriveFaults faults;
    bool connected = true;
    Time free_at{};  // it answers in order
    Time next_babble{};
  };
  static constexpr std::size_t host = static_cast<std::size_t>(-1);
  struct Waiting {
    Time ready;
    std::uint64_t order;
    std::size_t from;  // a position, or `host`
    std::uint64_t tag;
    BusFrame frame;
  };
  struct OnWire {
    Time end;
    Waiting what;
  };

  std::optional<Time> next_start() const;
  std::optional<std::size_t> winner(Time at) const;
  void start(Time at);
  void arrive(const Waiting& what, Time at);
  void hear(std::size_t position, const BusFrame& frame, std::uint64_t tag, Time at);
  void request_arrives(std::size_t position, const BusFrame& frame, std::uint64_t tag, Time at);
  void take_output(std::size_t position, Time at, CanExchange* exchange);
  void answer(std::size_t position, const CanOutput& output, Time at, CanExchange* exchange);
  void wait(Time ready, std::size_t from, std::uint64_t tag, const BusFrame& frame);
  void babble(Time now);

  CanLineOptions options_;
  Random random_;
  CanToHostSink sink_;
  CanJournal journal_;
  std::vector<Slot> slots_;
  std::vector<Waiting> waiting_;
  std::optional<OnWire> on_wire_;
  Time wire_free_{};
  Time owed_until_{};
  std::uint64_t overlapping_ = 0;
  std::uint64_t order_ = 0;
  std::uint64_t tags_ = 0;
  bool bus_off_ = false;
  Time now_{};
};

}  // namespace axisgate::simulated
