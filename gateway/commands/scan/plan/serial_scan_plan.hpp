// SPDX-License-Identifier: Apache-2.0
// What `axisgate scan` asks of a serial line, and what it makes of the answers: at which protocol, rate and station
// somebody answers, and which profile fits him. Pure: exchanges and results. Promises one exchange at a time, reads
// only, a bound on all of them that is known before the first, and that a station which falls silent is left. Never
// writes, and never takes a fit for certain. What it says in one protocol is no write in the
// other one either.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/commands/scan/plan/scan_plan.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/profile/read/profile.hpp"

namespace axisgate::commands {

/// Stations that each protocol has at all: Kinco's tool reaches every drive by 127; RTU's 248 to 255 are reserved.
inline constexpr std::uint8_t kLastKincoStation = 126;
inline constexpr std::uint8_t kLastRtuStation = 247;

/// What is spoken, and how fast.
struct SerialSpeech {
  std::string protocol;  ///< as adapters are called: "kinco-serial", "modbus-rtu"
  std::uint32_t baud = 38400;
  friend bool operator==(const SerialSpeech&, const SerialSpeech&) = default;
};

struct SerialScanSettings {
  std::vector<std::string> protocols{"kinco-serial", "modbus-rtu"};
  std::vector<std::uint32_t> bauds{38400, 19200, 9600, 115200};
  ScanRange stations{1, 32};
};

struct FoundStation {
  SerialSpeech speech;
  std::uint8_t station = 0;
  bool fell_silent = false;
  std::vector<ScanFit> fits;  ///< the best first; those that have less than half are left out
};

class SerialScanPlan {
 public:
  static constexpr int kSilences = 3;             ///< in a row: the station is left
  static constexpr std::size_t kMostTried = 512;  ///< objects tried of one station

  SerialScanPlan(const std::vector<profile::Profile>& profiles, const SerialScanSettings& settings);

  /// What must be spoken for next(); none: the scan is over.
  [[nodiscard]] std::optional<SerialSpeech> speech() const;
  /// The next read; none: this speech is over (speech() is another one), or all is. The same until on_result().
  [[nodiscard]] std::optional<bus::Exchange> next() const;
  /// Of the exchange that next() gave. timed_out: nobody answered.
  void on_result(const bus::ExchangeResult& result);

  /// Reads that are sent to stations that do not answer, all together.
  [[nodiscard]] int knocks() const { return knocks_; }
  [[nodiscard]] int knocked() const { return knocked_; }
  [[nodiscard]] bool knocking() const { return !reading_; }
  [[nodiscard]] const std::vector<FoundStation>& found() const { return found_; }

 private:
  struct Tried {
    ObjectAddress address;
    std::uint8_t size = 0;
    bool has = false;
  };
  struct Protocol {
    std::string name;
    std::vector<profile::Profile> profiles;
    std::vector<Tried> objects;         ///< of all its profiles, each once
    std::vector<ObjectAddress> knocks;  ///< one that each profile has; the shared ones once
    std::uint8_t last_station = 0;
  };
  [[nodiscard]] static Protocol protocol_of(const std::string& name, const std::vector<profile::Profile>& profiles,
                                            const ScanRange& stations);
  [[nodiscard]] static std::vector<ObjectAddress> knocks_for(const std::vector<profile::Profile>& profiles,
                                                             const std::vector<Tried>& objects,
                                                             const std::string& protocol);
  [[nodiscard]] const Protocol& protocol() const { return protocols_[protocol_]; }
  /// The read of this step, such that a Kinco drive on the line takes it for none of its writes: its frames have no
  /// beginning, and whatever ten bytes have the right sum are one. Steps for which there is no such read are left out.
  void choose();
  [[nodiscard]] bool is_safe(const bus::Exchange& exchange) const;
  void note_sent();
  void take(const bus::ExchangeResult& result);
  void next_knock();
  void next_station();
  void next_speech();
  void end_station();
  [[nodiscard]] std::vector<ScanFit> fits() const;

  std::vector<Protocol> protocols_;
  std::vector<std::uint32_t> bauds_;
  ScanRange stations_;
  std::size_t baud_ = 0, protocol_ = 0, knock_ = 0, object_ = 0;
  int station_ = 0;
  bool reading_ = false;
  bool over_ = false;
  int silences_ = 0;
  int knocks_ = 0, knocked_ = 0;
  std::vector<Tried> tried_;
  std::optional<bus::Exchange> chosen_;
  std::vector<Byte> sent_;  ///< at this rate, the last bytes, in which a frame might begin
  FoundStation current_;
  std::vector<FoundStation> found_;
};

/// How long it takes where nobody answers.
[[nodiscard]] Duration longest_silence(const SerialScanPlan& plan, Duration timeout);
/// A table of what answered, and what a configuration of it begins with; empty where nobody did.
[[nodiscard]] std::string serial_scan_table(const std::vector<FoundStation>& found, const std::string& device);

}  // namespace axisgate::commands
