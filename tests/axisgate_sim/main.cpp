// SPDX-License-Identifier: Apache-2.0
// axisgate-sim: simulated drives on pseudo-terminals and CAN interfaces, for demos, tests and benchmarks.
#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>

#include "gateway/manual/generate.hpp"
#include "tests/axisgate_sim/run.hpp"

using namespace axisgate::simulated;

namespace {

struct Options {
  std::vector<std::string> lines;
  std::vector<std::string> faults;
  std::string control;
  std::string terminals;
  bool cascade = false;
  bool rs485 = false;
  bool factory_fresh = false;
  std::optional<double> reply_delay_ms;
  double frame_gap_ms = 2;
  double boot_ms = 1000;
  double store_ms = 50;
  std::uint32_t baud = 0;
  std::uint64_t seed = 1;
};

Time milliseconds_of(double amount) { return Time{static_cast<std::int64_t>(amount * 1e6)}; }

void describe_options(CLI::App& app, Options& options) {
  app.footer(
      "Example: axisgate-sim --line /tmp/lift:jd@1 --line /tmp/table:md@1,jd@2 --cascade --control /tmp/sim.sock\n"
      "Modbus RTU:  axisgate-sim --line /tmp/axes:rtu:id286pro@1,jd@2,md@3\n"
      "CANopen:     axisgate-sim --line vcan0:can:ld2@1,jd@2,md@3, or --line /tmp/adapter:lawicel:ld2@1 for a serial\n"
      "             CAN adapter (Lawicel) on a pty\n"
      "A drive may carry +fresh, +cascade, +home=FROM..TO and +limits=FROM..TO (counts of the motor): jd@1+fresh.\n"
      "On Modbus RTU a Kinco may carry +errors=83, the others any stored register: id286pro@1+400=11+home=0..500.\n"
      "On CANopen a drive may carry +block (SDO block transfer), a Kinco +short (replies shorter than 8 bytes), an "
      "ld2\n"
      "+ack (statusword bit 12 in profile position) and any stored object: ld2@1+2008.00=10000+6085.00=500000.\n"
      "Keya KYDAS4860-2E (two motors): --line /tmp/cart:keya-rs232, --line /tmp/carts:keya-rs485@1,keya-rs485@2,\n"
      "             --line vcan0:keya-can@1 (its maker's protocol), --line vcan0:can:keya-kydas4860-2e@1 (CANopen); it "
      "may\n"
      "             carry any parameter of its manual: keya-rs232+0020=3+0050=4, and +coast|+ramp, +queries-feed,\n"
      "             +repeat-ignored, +zero-ignored, +other-kept, +sub-00, +keeps-counts, +period-only, +heartbeat=MS.\n"
      "The control socket takes text lines: echo 'unresponsive lift/1 on' | socat - UNIX:/tmp/sim.sock; 'help' lists "
      "them.");
  app.add_option(
         "--line", options.lines,
         "PATH:TYPE@STATION[,TYPE@STATION...], type jd or md; PATH:rtu:TYPE@UNIT[,...] for Modbus RTU, type "
         "jd, md, id286pro, em2rs, cs2rs or zlac8015d; one pty each, linked at PATH. IFACE:can:TYPE@NODE[,...] for "
         "CANopen on a "
         "SocketCAN interface, PATH:lawicel:TYPE@NODE[,...] behind a serial CAN adapter, type jd, md, ld2, keya-can "
         "or keya-kydas4860-2e; PATH:keya-rs232 or PATH:keya-rs485@NODE[,...] for a Keya's serial protocols")
      ->required();
  app.add_flag("--cascade", options.cascade,
               "All drives have 6510:0B = 1 and return the host's frames, as several on one RS232 line always do");
  app.add_flag("--rs485", options.rs485, "The lines are RS485 with Kinco's protocol (MD drives only)");
  app.add_flag("--factory-fresh", options.factory_fresh,
               "Drives as delivered: DIN1 and DIN3 block the bus, limits unwired; an id286pro waits for pulses, an "
               "input enables an em2rs");
  app.add_option("--reply-delay-ms", options.reply_delay_ms,
                 "Time a drive takes to answer; else 0, 20 for an id286pro, and 1 on CAN")
      ->check(CLI::Range(0.0, 60000.0));
  app.add_option("--boot-ms", options.boot_ms, "Time a restarted drive is silent")->check(CLI::Range(0.0, 600000.0));
  app.add_option("--store-ms", options.store_ms, "Time a store to the EEPROM takes")->check(CLI::Range(0.0, 600000.0));
  app.add_option("--baud-timing", options.baud, "Let each byte take its time at this rate; 0: none")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--frame-gap-ms", options.frame_gap_ms,
                 "Modbus RTU: the silence that ends a frame where no baud rate gives it")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--seed", options.seed, "Seed of the faults' chances");
  app.add_option("--fault", options.faults,
                 "NAME@LINE/STATION[=RATE], for example unresponsive@lift/1 or corrupt@table/2=0.01");
  app.add_option("--control", options.control, "Path of a Unix socket that takes commands while the simulator runs")
      ->type_name("PATH");
  app.add_option("--terminals", options.terminals,
                 "Folder of a devpts in which the ptys are made, for containers that share it; else the system's")
      ->type_name("DIR");
}

void build(Simulator& simulator, Control& control, const Options& options) {
  DriveOptions drive;
  drive.cascade = options.cascade;
  drive.factory_fresh = options.factory_fresh;
  drive.boot_time = milliseconds_of(options.boot_ms);
  drive.store_time = milliseconds_of(options.store_ms);
  LineTimings timings;
  timings.serial.wiring = options.rs485 ? Wiring::rs485 : Wiring::rs232;
  timings.serial.baud = timings.rtu.baud = timings.keya.baud = options.baud;
  timings.serial.reply_delay = timings.keya.reply_delay = milliseconds_of(options.reply_delay_ms.value_or(0));
  if (options.reply_delay_ms) timings.rtu.reply_delay = milliseconds_of(*options.reply_delay_ms);
  if (options.reply_delay_ms) timings.can.reply_delay = milliseconds_of(*options.reply_delay_ms);
  timings.can.bit_rate = 0;  // a real interface takes its own time, and an adapter is told its rate
  if (options.baud == 0) timings.rtu.frame_gap = milliseconds_of(options.frame_gap_ms);
  std::uint64_t seed = options.seed;
  for (const std::string& text : options.lines) {
    LineSpec spec = parse_line_spec(text, drive);
    // Several drives on RS232 are a chain, which works with 6510:0B = 1 in each of them only (JD 2.1).
    const bool chain = spec.drives.size() > 1 && !options.rs485;
    for (DriveOptions& one : spec.drives) one.cascade = one.cascade || chain;
    simulator.add(spec, timings, seed++);
  }
  for (const std::string& text : options.faults) control.set_fault(text);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Simulated Kinco JD, MD, iD286pro, Leadshine LD2-CAN and Keya KYDAS4860-2E drives on pseudo-terminals and CAN "
      "interfaces, as their makers' manuals describe them, and drives that only their EDS is known of.",
      "axisgate-sim"};
  Options options;
  describe_options(app, options);
  if (const auto text = axisgate::manual::generated(app, argc, argv)) {
    std::cout << *text;
    return 0;
  }
  CLI11_PARSE(app, argc, argv);
  try {
    const Descriptor end_signals = block_end_signals();
    Simulator simulator(options.terminals);
    Control control(simulator);
    std::optional<ControlSocket> socket;
    build(simulator, control, options);
    if (!options.control.empty()) {
      socket.emplace(options.control, control);
      std::cout << "control " << options.control << std::endl;
    }
    run(simulator, socket ? &*socket : nullptr, end_signals);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "axisgate-sim: " << error.what() << '\n';
    return 1;
  }
}
