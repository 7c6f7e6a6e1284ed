// SPDX-License-Identifier: Apache-2.0
// axisgate-bench: the figures of the design's section 8, each as a ratio to a bare loop of the same run.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/benches.hpp"

namespace {

using namespace axisgate::bench;

struct Bench {
  std::string_view name;
  std::string_view what;
  void (*run)(const BenchOptions&);
};

template <void (*bench)(const BenchOptions&, LineProtocol), LineProtocol protocol>
void on(const BenchOptions& options) {
  bench(options, protocol);
}
constexpr LineProtocol kKinco = LineProtocol::kinco_serial;
constexpr LineProtocol kRtu = LineProtocol::modbus_rtu;
constexpr LineProtocol kSlcan = LineProtocol::slcan;
constexpr LineProtocol kVcan = LineProtocol::vcan;

constexpr std::array kBenches{
    Bench{"immediate", "P2: time added to an exchange with a drive that answers at once", on<immediate_drive, kKinco>},
    Bench{"delayed", "P2: share of a bare loop's rate with a drive that answers after 5 ms", on<delayed_drive, kKinco>},
    Bench{"stops", "P4: exchanges before a stop, behind 32 busy clients", on<stop_latency, kKinco>},
    Bench{"reads", "P5: Modbus reads per second beside a bare Asio echo server", modbus_reads},
    Bench{"crowd", "reads among 1000 clients, 200 of them slow, and connections per second, beside an echo server",
          crowd},
    Bench{"sharing", "P6: exchanges on the bus with 0, 1 and 32 reading clients", on<shared_polling, kKinco>},
    Bench{"footprint", "P8: memory and processor time", footprint},
    Bench{"rtu-immediate", "P2 on Modbus RTU, beside libmodbus in a loop", on<immediate_drive, kRtu>},
    Bench{"rtu-delayed", "P2 on Modbus RTU, drives that answer at once and after 5 ms", on<delayed_drive, kRtu>},
    Bench{"rtu-dead", "P3: a live drive's writes beside a dead one, on Modbus RTU", on<dead_neighbour, kRtu>},
    Bench{"rtu-stops", "P4 on Modbus RTU", on<stop_latency, kRtu>},
    Bench{"rtu-sharing", "P6 on Modbus RTU", on<shared_polling, kRtu>},
    Bench{"slcan-immediate", "P2 on CANopen behind a serial adapter, beside its text in a loop",
          on<immediate_drive, kSlcan>},
    Bench{"slcan-delayed", "P2 on CANopen behind a serial adapter, at once and after 5 ms", on<delayed_drive, kSlcan>},
    Bench{"slcan-change", "from a TPDO to the register that shows it", on<change_latency, kSlcan>},
    Bench{"slcan-idle", "SDO requests while drives are online and stand", idle_can},
    Bench{"keepalive", "gaps between the commands that keep a Keya's motors alive, with 0 and 32 busy clients",
          keepalive},
    Bench{"lease", "from a client's death to the stop on the wire, on every protocol", lease_expiry},
    Bench{"vcan-immediate", "P2 on CANopen, beside a raw CAN socket in a loop", on<immediate_drive, kVcan>},
    Bench{"vcan-delayed", "P2 on CANopen, nodes that answer at once and after 5 ms", on<delayed_drive, kVcan>},
    Bench{"vcan-change", "from a TPDO to the register that shows it", on<change_latency, kVcan>},
    Bench{"vcan-babble", "what a babbling node costs the other bus", babbling_bus},
};

/// A folder for one run; gone with the object.
class RunFolder {
 public:
  RunFolder() : path_((std::filesystem::temp_directory_path() / "axisgate-bench-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error("no folder for this run");
  }
  ~RunFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

constexpr std::string_view kUsage =
    "usage: axisgate-bench [--quick] [--json FILE] [--axisgate PROGRAM] BENCH...\n"
    "--json adds each row to a file; --quick shows in seconds that they work: its figures mean nothing.\n"
    "Those of vcan want an interface vcan0. All are run by tests/bench/run.\n";

int help(int status) {
  fmt::print("{}", kUsage);
  for (const Bench& bench : kBenches) fmt::print("  {:<16} {}\n", bench.name, bench.what);
  return status;
}

/// How many could not be measured: the others are, nevertheless.
int failures(const std::vector<const Bench*>& chosen, const BenchOptions& options) {
  int failed = 0;
  for (const Bench* bench : chosen) {
    options.report.begin(bench->name);
    try {
      bench->run(options);
    } catch (const std::exception& error) {
      fmt::print(stderr, "axisgate-bench: {}: {}\n", bench->name, error.what());
      ++failed;
    }
  }
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  std::string program = AXISGATE_PROGRAM, json;
  bool quick = false;
  std::vector<const Bench*> chosen;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--help") return help(0);
    const auto bench = std::ranges::find(kBenches, word, &Bench::name);
    if (word == "--quick")
      quick = true;
    else if (word == "--json" && i + 1 < argc)
      json = argv[++i];
    else if (word == "--axisgate" && i + 1 < argc)
      program = argv[++i];
    else if (bench != kBenches.end())
      chosen.push_back(&*bench);
    else
      return help(2);
  }
  try {
    Report report(json);
    const RunFolder folder;
    return failures(chosen, {report, program, folder.path(), quick}) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-bench: {}\n", error.what());
    return 1;
  }
}
