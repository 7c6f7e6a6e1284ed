// One serial line with its simulated drives, as the host's end of the cable sees it: bytes in, bytes out, time pushed
// in. Promises: an RS232 chain gives the host's bytes back exactly when every drive in it has 6510:0B = 1 (JD 2.1); a
// drive answers in order; the same seed and the same calls give the same bytes at the same times. Never reads a clock
// and never delivers a byte outside from_host() and advance().
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tests/simulated/drive_faults.hpp"
#include "tests/simulated/frame_receiver.hpp"
#include "tests/simulated/journal.hpp"
#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

// rs232: one drive, or a chain in which each hears what the one before it passes on. rs485: all hear the host.
enum class Wiring : std::uint8_t { rs232, rs485 };

enum class ByteOrigin : std::uint8_t { echo, reply, noise };

struct ToHost {
  Time at;            // when the last of the bytes has arrived
  std::uint64_t tag;  // of the request that caused a reply; 0 for echo and noise
  ByteOrigin origin;
  std::span<const std::uint8_t> bytes;
};

struct LineOptions {
  Wiring wiring = Wiring::rs232;
  std::uint32_t baud = 0;   // 10 bits per byte at this rate; 0: bytes take no time
  bool check_baud = false;  // a drive whose 2FE0 says another rate than `baud` hears nothing
  Time reply_delay{};       // between the request's last byte and the reply's first; the sheets give none
  std::size_t journal_capacity = 1000;
};

class SerialLine {
 public:
  using Sink = std::function<void(const ToHost&)>;  // may call from_host()

  SerialLine(const LineOptions& options, Random random, Sink sink);

  // Drives in the order of the chain. Throws std::invalid_argument for one that cannot be on this line.
  KincoDrive& add(const DriveOptions& options);
  std::size_t size() const { return slots_.size(); }
  KincoDrive& drive(std::size_t position) { return *slots_.at(position).drive; }
  const KincoDrive& drive(std::size_t position) const { return *slots_.at(position).drive; }
  DriveFaults& faults(std::size_t position) { return slots_.at(position).faults; }
  void set_reply_delay(Time delay) { options_.reply_delay = delay; }
  void restart(std::size_t position, Time now);  // with it go the replies it had not sent yet

  void from_host(std::span<const std::uint8_t> bytes, Time now);
  void advance(Time now);
  std::optional<Time> next_event() const;
  void cut() {
    incoming_.clear(), waiting_.clear(), arriving_.clear();
  }  // the cable is pulled: bytes under way are gone

  const Journal& journal() const { return journal_; }

 private:
  struct Slot {
    std::unique_ptr<KincoDrive> drive;
    DriveFaults faults;
    FrameReceiver receiver;
    Time reply_ready{};  // of its newest reply: it answers in order
    Time next_babble{};
  };
  struct IncomingByte {
    Time at;
    std::uint8_t byte;
  };
  struct Chunk {
    std::uint64_t tag;
    ByteOrigin origin;
    std::size_t drive;  // whose restart takes it away; the number of drives for an echo
    std::vector<std::uint8_t> bytes;
  };
  using ChunkQueue = std::map<std::pair<Time, std::uint64_t>, Chunk>;

  bool passes_on(const Slot& slot) const;
  bool hears(std::size_t position) const;
  bool reaches_host(std::size_t position) const;
  void byte_arrives(std::uint8_t byte, Time at);
  void flush_echo(Time at);
  void request_arrives(std::size_t position, const TenByteFrame& request, Time at);
  std::vector<std::uint8_t> distort(Slot& slot, TenByteFrame reply);
  void send_reply(std::size_t position, std::uint64_t tag, Time ready, std::vector<std::uint8_t> bytes);
  void send(Time ready, Chunk chunk);
  void put_on_wire(Time ready, Chunk chunk);
  void babble(Time now);
  std::vector<std::uint8_t> noise(const DriveFaults& faults);
  Time duration(std::size_t bytes) const;

  LineOptions options_;
  Random random_;
  Sink sink_;
  Journal journal_;
  std::vector<Slot> slots_;
  std::deque<IncomingByte> incoming_;
  ChunkQueue waiting_;   // by the time the drive begins to send
  ChunkQueue arriving_;  // by the time the last byte is there
  std::vector<std::uint8_t> echo_;
  Time host_line_free_{};   // host to drives
  Time drive_line_free_{};  // drives to host
  Time now_{};
  std::uint64_t tags_ = 0;
  std::uint64_t chunks_ = 0;
};

}  // namespace axisgate::simulated
