// axisgate-bench: the figures of the design's section 8, each as a ratio to a bare loop of the same run.
#include <fmt/format.h>
#include <net/if.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tests/bench/babbling_bus.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/change_latency.hpp"
#include "tests/bench/delayed_drive.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/footprint.hpp"
#include "tests/bench/idle_can.hpp"
#include "tests/bench/immediate_drive.hpp"
#include "tests/bench/keepalive.hpp"
#include "tests/bench/lease_expiry.hpp"
#include "tests/bench/modbus_reads.hpp"
#include "tests/bench/mute_neighbour.hpp"
#include "tests/bench/shared_polling.hpp"
#include "tests/bench/stop_latency.hpp"

namespace {

using namespace axisgate::bench;

struct Bench {
  std::string_view name;
  std::string_view what;
  void (*run)(const BenchOptions&);
  bool needs_vcan = false;
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
    Bench{"reads", "P5: Modbus reads per second beside a bare Asio echo server",
          [](const BenchOptions& options) {
            modbus_reads(options.quick ? ReadsOptions{3, 100} : ReadsOptions{});
          }},
    Bench{"sharing", "P6: exchanges on the bus with 0, 1 and 32 reading clients", on<shared_polling, kKinco>},
    Bench{"footprint", "P8: memory and processor time", footprint},
    Bench{"rtu-immediate", "P2 on Modbus RTU, beside libmodbus in a loop", on<immediate_drive, kRtu>},
    Bench{"rtu-delayed", "P2 on Modbus RTU, drives that answer at once and after 5 ms", on<delayed_drive, kRtu>},
    Bench{"rtu-mute", "P3: a live drive's writes beside a dead one, on Modbus RTU", on<mute_neighbour, kRtu>},
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
    Bench{"vcan-immediate", "P2 on CANopen, beside a raw CAN socket in a loop", on<immediate_drive, kVcan>, true},
    Bench{"vcan-delayed", "P2 on CANopen, nodes that answer at once and after 5 ms", on<delayed_drive, kVcan>, true},
    Bench{"vcan-change", "from a TPDO to the register that shows it", on<change_latency, kVcan>, true},
    Bench{"vcan-babble", "what a babbling node costs the other bus", babbling_bus, true},
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

int help(int status) {
  fmt::print(
      "usage: axisgate-bench [--quick] [--axisgate PROGRAM] [BENCH...]\nWithout a name, all of these run, those of "
      "vcan where\n"
      "there is an interface vcan0 (tests/vcan/in_guest -- axisgate-bench ...):\n");
  for (const Bench& bench : kBenches) fmt::print("  {:<16} {}\n", bench.name, bench.what);
  fmt::print("--quick shows in seconds that they work; its figures mean nothing.\n");
  return status;
}

const Bench* find(std::string_view name) {
  for (const Bench& bench : kBenches)
    if (bench.name == name) return &bench;
  return nullptr;
}

void run(const std::vector<const Bench*>& chosen, BenchOptions options) {
  const RunFolder folder;
  options.folder = folder.path();
  for (const Bench* bench : chosen) {
    fmt::print("--- {}: {}\n", bench->name, load_of_the_machine());
    std::fflush(stdout);
    bench->run(options);
  }
  fmt::print("--- end: {}\n", load_of_the_machine());
}

}  // namespace

int main(int argc, char** argv) {
  BenchOptions options;
  options.program = AXISGATE_PROGRAM;
  std::vector<const Bench*> chosen;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--help") return help(0);
    if (word == "--quick") {
      options.quick = true;
    } else if (word == "--axisgate" && i + 1 < argc) {
      options.program = argv[++i];
    } else if (const Bench* bench = find(word)) {
      chosen.push_back(bench);
    } else {
      return help(2);
    }
  }
  if (chosen.empty())
    for (const Bench& bench : kBenches)
      if (!bench.needs_vcan || ::if_nametoindex("vcan0") != 0) chosen.push_back(&bench);
  try {
    run(chosen, options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
